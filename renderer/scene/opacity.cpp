#include "renderer/scene/opacity.h"

#include "renderer/core/sampler.h"
#include "renderer/scene/scene.h"

namespace tessera {

bool opacity_stops(const void* opaque_scene, const Hit& hit, std::uint32_t seed) noexcept {
    const Scene& scene = *static_cast<const Scene*>(opaque_scene);
    const Geometry& g = scene.geometry();
    const HitTarget target = scene.accel().target(hit);
    const Placement& placed = g.placements[target.placement];
    const Mesh& mesh = g.meshes[placed.shape];  // only meshes have cut-out parts
    const std::uint32_t face = mesh.parts[target.part].first_face + hit.prim;
    const int material =
        placed.material >= 0 ? placed.material : mesh.materials[mesh.material_slot(face)];
    const ShaderProgram& program = scene.program(material);
    if (!program.facts().cutout) return true;
    const Vec2f uv =
        program.facts().opacity_textured ? surface_uv(mesh, face, hit.u, hit.v) : Vec2f{};
    const float opacity = program.opacity(uv, scene.textures());
    if (opacity >= 1.0f) return true;
    if (opacity <= 0.0f) return false;
    const std::uint32_t h = hash_combine(hash_combine(seed, face), target.placement + 0x51ed270bu);
    return static_cast<float>(h >> 8) * 0x1p-24f < opacity;
}

}  // namespace tessera
