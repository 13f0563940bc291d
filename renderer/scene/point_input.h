#pragma once
// What a program may ask of a surface point, whoever looks at it.

#include <cmath>

#include "renderer/core/sampler.h"
#include "renderer/scene/scene.h"

namespace tessera {

/// The part that says how a surface lies, its normal outward: all that a normal map needs.
inline void orient_input(const SurfacePoint& s, ShadeInput& in) {
    in.n = s.ns;
    in.front = true;
    in.dpdu = s.dpdu, in.dpdv = s.dpdv, in.handed = s.handed;
}

/// The part of a ShadeInput that says where a point lies; its normal looks outward.
inline void place_input(const Scene& scene, const SurfacePoint& s, ShadeInput& in) {
    const Placement& placed = scene.geometry().placements[s.placement];
    in.p_object = placed.to_object.point(s.p);
    in.object_scale = placed.object_scale;
    in.p_world = Vec3f(Vec3d(s.p) + scene.origin());
    orient_input(s, in);
    if (scene.name_ids()) {
        const NameIds& names = *scene.name_ids();
        const NameKeys keys = names.keys(scene.geometry(), s);
        in.object_name = names.id(NameKind::object, keys);
        in.material_name = names.id(NameKind::material, keys);
        in.instance_name = names.id(NameKind::asset, keys);
        in.instance = hash_combine(in.instance_name, names.copy(s));
    }
    in.to_object = &placed.to_object;
    if (placed.kind == PlacedKind::mesh)
        in.creases = &scene.geometry().meshes[placed.shape].creases;
}

/// The point as a ray along d sees it; d need not be of unit length.
inline void look_along(Vec3f d, const SurfacePoint& s, ShadeInput& in) {
    in.front = dot(s.ng, d) <= 0.0f;
    in.n = in.front ? s.ns : -s.ns;
    in.view = normalize(d);
    in.facing = std::fabs(dot(s.ns, d)) / length(d);
}

/// What a sampled point of an emissive mesh sends towards a point that sees it along d.
inline Color emitter_radiance(const Scene& scene, std::int32_t material, std::uint32_t placement,
                              Vec2f uv, Vec3f p, Vec3f n, Vec3f d) {
    const ShaderProgram& program = scene.program(material);
    ShadeInput in;
    in.uv = uv;
    if (program.facts().emission_geometry || program.facts().opacity_geometry) {
        SurfacePoint s;
        s.p = p;
        s.ng = s.ns = n;
        s.placement = placement;
        s.material = material;
        place_input(scene, s, in);
        look_along(d, s, in);
    }
    return program.visible_emission(in, scene.textures(), -dot(n, d));
}

}  // namespace tessera
