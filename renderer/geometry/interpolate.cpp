#include "renderer/geometry/interpolate.h"

#include <algorithm>
#include <cmath>

#include "renderer/geometry/mesh_point.h"

namespace tessera {
namespace {

void texture_frame_to_world(const Affinef& m, SurfacePoint& s) {
    s.dpdu = m.vector(s.dpdu);
    s.dpdv = m.vector(s.dpdv);
    if (m.determinant() < 0.0f) s.handed = -s.handed;
    const float scale = std::cbrt(std::fabs(m.determinant()));
    s.uv_per_length = scale > 0.0f ? s.uv_per_length / scale : 0.0f;
}

void mesh_texture_frame(const Mesh& mesh, const Hit& hit, SurfacePoint& s) {
    if (mesh.uv_at == 0) return;
    const Corners k = corners_of(mesh, s.face, hit.u, hit.v);
    const std::uint32_t ia = mesh.index[k.a], ib = mesh.index[k.b], ic = mesh.index[k.c];
    const Vec2f ta = mesh.uv(ia), tb = mesh.uv(ib), tc = mesh.uv(ic);
    s.uv = ta * k.wa + tb * k.wb + tc * k.wc;
    const Vec3f a = mesh.position(ia);
    const Vec3f ab = mesh.position(ib) - a, ac = mesh.position(ic) - a;
    const Vec2f e1 = tb - ta, e2 = tc - ta;
    const float uv_area2 = e1.x * e2.y - e2.x * e1.y;
    s.uv_per_length = std::sqrt(std::fabs(uv_area2) / length(cross(ab, ac)));
    s.handed = uv_area2 < 0.0f ? -1.0f : 1.0f;
    if (uv_area2 == 0.0f) return;
    s.dpdu = (ab * e2.y - ac * e1.y) * (1.0f / uv_area2);
    s.dpdv = (ac * e1.x - ab * e2.x) * (1.0f / uv_area2);
}

// Embree solves the sphere in float; its t only says which of the two roots was meant.
Point sphere_point(const Sphere& sphere, const Ray& local, float t, SurfacePoint& s) {
    const Vec3d d(local.d), oc = Vec3d(local.o) - Vec3d(sphere.center);
    const double r = static_cast<double>(sphere.radius), a = length2(d), b = dot(oc, d);
    const Vec3d closest =
        oc - d * (b / a);  // nearest point of the line to the centre: no cancellation
    const double reach = std::sqrt(std::max(0.0, (r * r - length2(closest)) / a));
    const double middle = -b / a;
    const double root = static_cast<double>(t) < middle ? middle - reach : middle + reach;
    Vec3d n = oc + d * root;
    n = n * (1.0 / length(n));
    const double turn = std::atan2(n.x, n.z) / (2.0 * 3.14159265358979323846);
    s.uv = {static_cast<float>(turn < 0 ? turn + 1 : turn),
            static_cast<float>(std::acos(std::max(-1.0, std::min(1.0, -n.y))) /
                               3.14159265358979323846)};
    s.dpdu = Vec3f(Vec3d{n.z, 0, -n.x} * (2.0 * 3.14159265358979323846 * r));
    const double ring = std::sqrt(n.x * n.x + n.z * n.z);
    if (ring > 0)
        s.dpdv =
            Vec3f(Vec3d{-n.x * n.y / ring, ring, -n.z * n.y / ring} * (3.14159265358979323846 * r));
    s.uv_per_length = 1.0f / (kPi * sphere.radius);
    // Embree's own float solution is good to a few roundings of centre and radius.
    return {Vec3f(Vec3d(sphere.center) + n * r),
            (abs(sphere.center) + Vec3f(sphere.radius)) * gamma_bound(16),
            Vec3f(n),
            Vec3f(n),
            {}};
}

Point disc_point(const Disc& disc, const Ray& local, SurfacePoint& s) {
    const Vec3d n(disc.normal), d(local.d), co = Vec3d(disc.center) - Vec3d(local.o);
    const Vec3d p = Vec3d(local.o) + d * (dot(co, n) / dot(d, n));
    const Frame frame(disc.normal);
    const Vec3f q = Vec3f(p - Vec3d(disc.center));
    s.uv = {0.5f + 0.5f * dot(q, frame.s) / disc.radius,
            0.5f + 0.5f * dot(q, frame.t) / disc.radius};
    s.dpdu = frame.s * (2.0f * disc.radius);
    s.dpdv = frame.t * (2.0f * disc.radius);
    s.uv_per_length = 0.5f / disc.radius;
    return {Vec3f(p),
            abs(disc.center) * gamma_bound(8) + Vec3f(disc.radius * gamma_bound(8)),
            disc.normal,
            disc.normal,
            {}};
}

// The ray in the space of an instanced shape, in double.
Ray to_local(const Affinef& m, const Ray& ray) {
    const Affined back = inverse(Affined(m));
    return {Vec3f(back.point(Vec3d(ray.o))), Vec3f(back.vector(Vec3d(ray.d))), ray.t_max, ray.mask};
}

}  // namespace

SurfacePoint surface_point(const Geometry& geometry, const HitTarget& target, const Hit& hit,
                           const Ray& ray, bool colors) noexcept {
    SurfacePoint s;
    const Placement& placed = geometry.placements[target.placement];
    Point at;
    if (placed.kind == PlacedKind::mesh) {
        const Mesh& mesh = geometry.meshes[placed.shape];
        name_mesh_hit(placed, mesh, target, hit, s);
        at = mesh_point(face_corners(mesh, s.face, hit, colors, s.vertex_color));
    } else {
        s.placement = target.placement;
        s.light = placed.light;
        const Ray local = placed.instanced ? to_local(placed.to_world, ray) : ray;
        if (placed.kind == PlacedKind::sphere) {
            at = sphere_point(geometry.spheres[placed.shape], local, hit.t, s);
            s.material = geometry.spheres[placed.shape].material;
        } else {
            at = disc_point(geometry.discs[placed.shape], local, s);
            s.material = geometry.discs[placed.shape].material;
        }
        if (placed.material >= 0) s.material = placed.material;
    }
    if (placed.instanced) at = to_world(placed.to_world, placed.condition, at);
    put(at, s);
    return s;
}

void prefetch_index(const Geometry& geometry, const HitTarget& target, const Hit& hit) noexcept {
    const Placement& placed = geometry.placements[target.placement];
    if (placed.kind != PlacedKind::mesh) return;
    const Mesh& mesh = geometry.meshes[placed.shape];
    const std::uint32_t face = mesh.parts[target.part].first_face + hit.prim;
    __builtin_prefetch(&mesh.index[mesh.corner(face)]);
    if (!mesh.face_material.empty()) __builtin_prefetch(&mesh.face_material[face]);
}

void prefetch_vertices(const Geometry& geometry, const HitTarget& target, const Hit& hit) noexcept {
    const Placement& placed = geometry.placements[target.placement];
    if (placed.kind != PlacedKind::mesh) return;
    const Mesh& mesh = geometry.meshes[placed.shape];
    const std::size_t corner = mesh.corner(mesh.parts[target.part].first_face + hit.prim);
    for (std::size_t k = corner; k < corner + 3; ++k)
        __builtin_prefetch(mesh.record(mesh.index[k]));
}

void add_texture_frame(const Geometry& geometry, const Hit& hit, SurfacePoint& s) noexcept {
    const Placement& placed = geometry.placements[s.placement];
    // Spheres and discs have filled theirs in on the way.
    if (placed.kind == PlacedKind::mesh) mesh_texture_frame(geometry.meshes[placed.shape], hit, s);
    if (placed.instanced) texture_frame_to_world(placed.to_world, s);
}

Vec2f surface_uv(const Mesh& mesh, std::uint32_t face, float u, float v) noexcept {
    if (mesh.uv_at == 0) return {0, 0};
    const Corners k = corners_of(mesh, face, u, v);
    return mesh.uv(mesh.index[k.a]) * k.wa + mesh.uv(mesh.index[k.b]) * k.wb +
           mesh.uv(mesh.index[k.c]) * k.wc;
}

}  // namespace tessera
