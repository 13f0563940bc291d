#pragma once
// From a hit's ids to the surface point, in full float accuracy: positions come from the vertices
// and the barycentrics (or, on spheres and discs, from the equation in double), never from o + t d.

#include "renderer/core/ray.h"
#include "renderer/core/surface_point.h"
#include "renderer/geometry/accel.h"
#include "renderer/geometry/shapes.h"

namespace tessera {

/// Position, normals, ids; vertex colours if asked for. No texture coordinates yet.
SurfacePoint surface_point(const Geometry& geometry, const HitTarget& target, const Hit& hit,
                           const Ray& ray, bool colors) noexcept;

/// The same for the lanes of a block; the other lanes of `out` are left alone.
void surface_points(const Geometry& geometry, LaneMask lanes, const HitTarget (&targets)[kLanes],
                    const Hit (&hits)[kLanes], const Ray (&rays)[kLanes], bool colors,
                    SurfacePoint (&out)[kLanes]) noexcept;

/// Asks the cache for what surface_point will read of a mesh: first the index, later, when that has
/// come, the vertices. A block's lanes wait for memory together rather than one after the other.
void prefetch_index(const Geometry& geometry, const HitTarget& target, const Hit& hit) noexcept;
void prefetch_vertices(const Geometry& geometry, const HitTarget& target, const Hit& hit) noexcept;

/// Adds uv, dpdu and uv_per_length, for materials that read them.
void add_texture_frame(const Geometry& geometry, const Hit& hit, SurfacePoint& s) noexcept;

/// Texture coordinates alone, for the opacity test.
Vec2f surface_uv(const Mesh& mesh, std::uint32_t face, float u, float v) noexcept;

/// A point of a mesh's face: corner weights for a hit's u, v.
struct FaceWeights {
    std::uint32_t a, b, c;  // which corners, 0..3
    float wa, wb, wc;
};
/// Embree splits a quad into (0, 1, 3) and (2, 3, 1).
inline FaceWeights face_weights(bool quad, float u, float v) {
    if (!quad) return {0, 1, 2, 1.0f - u - v, u, v};
    if (u + v <= 1.0f) return {0, 1, 3, 1.0f - u - v, u, v};
    return {2, 3, 1, u + v - 1.0f, 1.0f - u, 1.0f - v};
}

}  // namespace tessera
