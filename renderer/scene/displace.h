#pragma once
// A diced surface evaluated and moved by its materials' displacement: a mesh as any other.

#include <functional>

#include "materials/displacement.h"
#include "renderer/core/affine.h"
#include "renderer/core/parallel.h"
#include "renderer/geometry/subdivide.h"
#include "renderer/scene/placement.h"

namespace tessera {

struct DisplaceInput {
    const MeshDesc& mesh;
    const Cage& cage;
    std::span<const int> rates;
    const LimitSurface& surface;
    std::vector<const Displacement*> by_slot;  // of the mesh's materials; null: stays
    const TextureStore* textures = nullptr;
    Affined to_world;  // where the graphs' world is, and what a scene unit comes to
};

struct DisplaceReport {
    std::uint64_t non_finite = 0;  // vertices left where they were
    double farthest = 0;           // that any was moved, units of the mesh
    std::uint32_t farthest_face = 0;
    Bounds before, after;
};

/// Scene units that one unit of what m places comes to.
double unit_of(const Affined& m);

/// Every vertex is moved once: where texture charts or materials meet, by the mean of what they
/// say. Vertices of one place have equal positions to the bit. Bits do not depend on workers.
MeshDesc displaced_mesh(const DisplaceInput& in, Diced&& diced, Workers& workers,
                        DisplaceReport& report);

}  // namespace tessera
