#pragma once
// The creases of a mesh, and how far the nearest one is.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/core/vec.h"

namespace tessera {

/// An edge at which faces meet at an angle.
struct Crease {
    Vec3f a, b;
    float bend = 0;  // radians between the faces' normals; below 0: concave seen from the front
};

/// A hierarchy of boxes over creases. Immutable; equal input gives an equal tree.
class CreaseTree {
public:
    CreaseTree() = default;
    /// Creases that are not finite are left out.
    explicit CreaseTree(std::vector<Crease> creases);

    bool empty() const noexcept { return creases_.empty(); }
    std::size_t size() const noexcept { return creases_.size(); }
    std::size_t bytes() const noexcept;
    /// Distance from p to the nearest crease that bends by `least` radians or more and is convex
    /// seen from the front, or from the back; `reach` if there is none as near.
    float distance(Vec3f p, float reach, float least, bool front) const noexcept;

private:
    // In preorder: the left child stands next, a leaf has no right one.
    struct Node {
        Vec3f lo, hi;
        std::uint32_t first = 0, last = 0, right = 0;
    };
    std::uint32_t build(std::uint32_t first, std::uint32_t last);

    std::vector<Crease> creases_;
    std::vector<Node> nodes_;
};

}  // namespace tessera
