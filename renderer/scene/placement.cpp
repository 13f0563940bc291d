#include "renderer/scene/placement.h"

#include <cmath>

namespace tessera {
namespace {

Bounds around(Vec3d center, double radius) {
    Bounds b;
    b.add(center - Vec3d(radius));
    b.add(center + Vec3d(radius));
    return b;
}

Bounds mesh_bounds(const MeshDesc& mesh) {
    Bounds b;
    for (std::uint32_t i : mesh.position_index) {
        b.add({mesh.positions[3 * std::size_t(i)], mesh.positions[3 * std::size_t(i) + 1],
               mesh.positions[3 * std::size_t(i) + 2]});
    }
    return b;
}

}  // namespace

Bounds instance_bounds(const SceneDesc& desc, const FlatInstance& instance) {
    Bounds local;
    switch (instance.kind) {
        case ShapeKind::mesh:
            local = mesh_bounds(desc.meshes[instance.index]);
            break;
        case ShapeKind::sphere:
            local = around(Vec3d(desc.spheres[instance.index].center),
                           desc.spheres[instance.index].radius);
            break;
        case ShapeKind::disc:
            local =
                around(Vec3d(desc.discs[instance.index].center), desc.discs[instance.index].radius);
            break;
        case ShapeKind::group:
            break;
    }
    Bounds world;
    if (local.empty()) return world;
    for (int corner = 0; corner < 8; ++corner) {
        world.add(instance.to_world.point({corner & 1 ? local.hi.x : local.lo.x,
                                           corner & 2 ? local.hi.y : local.lo.y,
                                           corner & 4 ? local.hi.z : local.lo.z}));
    }
    return world;
}

Bounds light_bounds(const LightDesc& light) {
    Bounds b;
    if (const auto* q = std::get_if<QuadLightDesc>(&light.shape)) {
        const Vec3d c(q->corner), u(q->edges[0]), v(q->edges[1]);
        for (const Vec3d& p : {c, c + u, c + v, c + u + v}) b.add(p);
    } else if (const auto* d = std::get_if<DiscLightDesc>(&light.shape)) {
        b = around(Vec3d(d->center), d->radius);
    } else if (const auto* s = std::get_if<SphereLightDesc>(&light.shape)) {
        b = around(Vec3d(s->center), s->radius);
    }
    return b;
}

Vec3d mesh_center(const MeshDesc& mesh) {
    const Bounds b = mesh_bounds(mesh);
    return b.empty() ? Vec3d{} : (b.lo + b.hi) * 0.5;
}

bool is_scaling(const Affined& m) {
    const double s = m.x.x, tolerance = 1e-12 * s * s;
    return s > 0 && length2(m.x - Vec3d{s, 0, 0}) < tolerance &&
           length2(m.y - Vec3d{0, s, 0}) < tolerance && length2(m.z - Vec3d{0, 0, s}) < tolerance;
}

bool is_similarity(const Affined& m) {
    const double a = length2(m.x), b = length2(m.y), c = length2(m.z), tolerance = 1e-6 * a;
    return std::abs(a - b) < tolerance && std::abs(a - c) < tolerance &&
           std::abs(dot(m.x, m.y)) < tolerance && std::abs(dot(m.x, m.z)) < tolerance &&
           std::abs(dot(m.y, m.z)) < tolerance;
}

}  // namespace tessera
