#include "renderer/scene/opacity.h"

#include "renderer/core/sampler.h"
#include "renderer/scene/point_input.h"

namespace tessera {
namespace {

// What an opacity graph can ask for: no footprint.
ShadeInput opacity_input(const Scene& scene, const HitTarget& target, const Hit& hit, Vec3f d,
                         Vec2f uv) {
    SurfacePoint s = surface_point(scene.geometry(), target, hit, Ray{}, true);
    add_texture_frame(scene.geometry(), hit, s);
    ShadeInput in;
    in.uv = uv;
    in.vertex_color = s.vertex_color;
    place_input(scene, s, in);
    const Placement& placed = scene.geometry().placements[target.placement];
    look_along(placed.instanced ? placed.to_world.vector(d) : d, s, in);
    return in;
}

}  // namespace

bool opacity_stops(const void* opaque_scene, const Hit& hit, Vec3f d, std::uint32_t seed) noexcept {
    const Scene& scene = *static_cast<const Scene*>(opaque_scene);
    const Geometry& g = scene.geometry();
    const HitTarget target = scene.accel().target(hit);
    const Placement& placed = g.placements[target.placement];
    std::int32_t material = placed.material;
    std::uint32_t face = 0;
    ShadeInput in;
    if (placed.kind == PlacedKind::mesh) {
        const Mesh& mesh = g.meshes[placed.shape];
        face = mesh.parts[target.part].first_face + hit.prim;
        if (material < 0) material = mesh.materials[mesh.material_slot(face)];
        const ProgramFacts& facts = scene.program(material).facts();
        if (facts.opacity_textured) in.uv = surface_uv(mesh, face, hit.u, hit.v);
        if (facts.opacity_geometry) in = opacity_input(scene, target, hit, d, in.uv);
    } else if (material < 0) {
        material = placed.kind == PlacedKind::sphere ? g.spheres[placed.shape].material
                                                     : g.discs[placed.shape].material;
    }
    const ShaderProgram& program = scene.program(material);
    if (!program.facts().cutout) return true;
    in.seed = seed;
    const float opacity = placed.kind == PlacedKind::mesh ? program.opacity(in, scene.textures())
                                                          : program.opacity_factor();
    if (opacity >= 1.0f) return true;
    if (opacity <= 0.0f) return false;
    const std::uint32_t h = hash_combine(
        hash_combine(seed, face), 2 * target.placement + (hit.far_side ? 1u : 0u) + 0x51ed270bu);
    return static_cast<float>(h >> 8) * 0x1p-24f < opacity;
}

}  // namespace tessera
