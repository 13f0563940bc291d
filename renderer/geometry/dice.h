#pragma once
// Cuts the faces of a cage into small ones. Every edge is cut by its own rate, once for all faces
// at it, and each face is filled in between: there is no crack to close.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/geometry/cage.h"

namespace tessera {

/// A point of a face. A quad has one patch: (0,0), (1,0), (1,1), (0,1) are its corners. A triangle
/// has three: corner k, the middle of the edge to the next, the middle of the face, the middle of
/// the edge from the one before.
struct DiceSite {
    std::uint32_t face = 0;
    std::uint32_t patch = 0;
    float s = 0, t = 0;
};

struct Diced {
    std::vector<DiceSite> sites;           // per vertex: where it is evaluated
    std::vector<std::uint32_t> place;      // per vertex; those on a texture seam share one
    std::uint32_t places = 0;              // some may be without a vertex
    std::vector<std::uint32_t> triangles;  // 3 vertices each
    std::vector<std::uint32_t> quads;      // 4
    std::vector<std::uint32_t> triangle_face, quad_face;  // of the cage

    std::size_t bytes() const noexcept;
};

/// Edges of triangles are cut in the middle: their rates are made even.
void make_even(const Cage& cage, std::vector<int>& rates);

/// How many triangles dice() will make; a quad counts as two.
std::uint64_t diced_triangles(const Cage& cage, std::span<const int> rates);

/// rates: pieces per edge, at least 1, through make_even.
Diced dice(const Cage& cage, std::span<const int> rates);

/// How finely a patch is cut along s and t.
struct PatchRates {
    int s = 1, t = 1;
};
PatchRates patch_rates(const Cage& cage, std::span<const int> rates, const DiceSite& site);

/// The share of each corner of the face in a point that lies straight between them.
struct CornerWeights {
    float w[4]{};
};
CornerWeights corner_weights(std::uint32_t corners, std::uint32_t patch, float s, float t);

}  // namespace tessera
