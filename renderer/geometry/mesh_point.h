#pragma once
// A point of a mesh from its face's corners, and its way into the scene: straight arithmetic, for
// one point or in a loop over lanes. Private to the interpolation.

#include <cmath>

#include "renderer/core/robust.h"
#include "renderer/geometry/interpolate.h"

namespace tessera {

/// What every point has. Apart from SurfacePoint, so that it lives in registers until it is done.
struct Point {
    Vec3f p, p_error, ng, ns, lift;
};

struct Corners {
    std::size_t a, b, c;  // entries of the index arrays
    float wa, wb, wc;
};

inline Corners corners_of(const Mesh& mesh, std::uint32_t face, float u, float v) {
    const FaceWeights w = face_weights(face >= mesh.triangles, u, v);
    const std::size_t first = mesh.corner(face);
    return {first + w.a, first + w.b, first + w.c, w.wa, w.wb, w.wc};
}

/// A face's corners as they are met in memory. Without normals n is zero.
struct FaceCorners {
    Vec3f a, b, c;
    Vec3f na, nb, nc;
    float wa, wb, wc;
};

inline FaceCorners face_corners(const Mesh& mesh, std::uint32_t face, const Hit& hit, bool colors,
                                Color& vertex_color) {
    const Corners k = corners_of(mesh, face, hit.u, hit.v);
    const std::uint32_t ia = mesh.index[k.a], ib = mesh.index[k.b], ic = mesh.index[k.c];
    FaceCorners f{
        mesh.position(ia), mesh.position(ib), mesh.position(ic), {}, {}, {}, k.wa, k.wb, k.wc};
    if (mesh.normal_at > 0) f.na = mesh.normal(ia), f.nb = mesh.normal(ib), f.nc = mesh.normal(ic);
    if (colors && mesh.color_at > 0)
        vertex_color = mesh.color(ia) * k.wa + mesh.color(ib) * k.wb + mesh.color(ic) * k.wc;
    return f;
}

/// How far p lies below the plane through a corner with its normal.
inline Vec3f depth_below(Vec3f p, Vec3f corner, Vec3f n) {
    return n * std::max(dot(corner - p, n), 0.0f);
}

inline Point mesh_point(const FaceCorners& f) {
    const Vec3f p = f.a * f.wa + f.b * f.wb + f.c * f.wc;
    // The rounding of the sum (PBRT 4e, eq. 6.24), and that of Embree's plane test, whose products
    // are of differences between the vertices and the ray's origin: as large as the face, whatever
    // the plane.
    const Vec3f ab = f.b - f.a, ac = f.c - f.a;
    const float reach = max_component(abs(ab) + abs(ac));
    const Vec3f error = (abs(f.a * f.wa) + abs(f.b * f.wb) + abs(f.c * f.wc)) * gamma_bound(7) +
                        Vec3f(reach * gamma_bound(3));
    const Vec3f normal = cross(ab, ac);
    const Vec3f ng = normal * (1.0f / std::sqrt(length2(normal)));
    const Vec3f n = f.na * f.wa + f.nb * f.wb + f.nc * f.wc;
    const float l2 = length2(n);
    const Vec3f ns = n * (1.0f / std::sqrt(l2));
    const bool smooth = l2 > 1e-12f;
    // The surface that the normals pretend: Hanika, "Hacking the Shadow Terminator", Ray Tracing
    // Gems II, 2021, chapter 4.
    // Halved: the mean of the depths is twice that below a sphere, to second order.
    const Vec3f lift = (depth_below(p, f.a, f.na) * f.wa + depth_below(p, f.b, f.nb) * f.wb +
                        depth_below(p, f.c, f.nc) * f.wc) *
                       0.5f;
    return {p, error, ng, pick(smooth, ns, ng), lift};
}

/// From the shape's space to the scene's.
inline Point to_world(const Affinef& m, float condition, const Point& at) {
    // Normals by the cofactors, their sign kept outward under a mirror.
    // Scaled first: the products of a huge map would overflow.
    const float scale = 1.0f / max_component(max(abs(m.x), max(abs(m.y), abs(m.z))));
    const Vec3f x = m.x * scale, y = m.y * scale, z = m.z * scale;
    const Affinef cofactor(cross(y, z), cross(z, x), cross(x, y), {});
    const float sign = dot(x, cofactor.x) < 0.0f ? -1.0f : 1.0f;
    return {m.point(at.p), error_in_place(m, condition, at.p, at.p_error),
            normalize(cofactor.vector(at.ng)) * sign, normalize(cofactor.vector(at.ns)) * sign,
            m.vector(at.lift)};
}

/// What was hit, by its numbers.
inline void name_mesh_hit(const Placement& placed, const Mesh& mesh, const HitTarget& target,
                          const Hit& hit, SurfacePoint& s) {
    s.placement = target.placement;
    s.light = placed.light;
    s.face = mesh.parts[target.part].first_face + hit.prim;
    s.material =
        placed.material >= 0 ? placed.material : mesh.materials[mesh.material_slot(s.face)];
}

inline void put(const Point& at, SurfacePoint& s) {
    s.p = at.p;
    s.p_error = at.p_error;
    s.ng = at.ng;
    const bool outward = dot(at.ns, at.ng) >= 0.0f;
    s.ns = outward ? at.ns : -at.ns;
    // What rounding makes of an even face is none.
    const bool lifted = outward && length2(at.lift) > 64.0f * length2(at.p_error);
    s.lift = lifted ? at.lift : Vec3f{};
}

}  // namespace tessera
