#pragma once
// Descriptions in a few lines, and the pictures they make.

#include <cstdint>
#include <vector>

#include "renderer/api/render.h"

namespace tessera {

inline MaterialDesc matte(float albedo) {
    MaterialDesc m;
    m.base_color.value = {albedo, albedo, albedo};
    m.specular_weight.value = 0;
    return m;
}

inline MaterialDesc metal(float roughness, float albedo = 1) {
    MaterialDesc m = matte(albedo);
    m.base_metalness.value = 1;
    m.specular_weight.value = 1;
    m.specular_roughness.value = roughness;
    return m;
}

inline MaterialDesc glass(float roughness, float ior = 1.5f) {
    MaterialDesc m;
    m.transmission_weight.value = 1;
    m.specular_roughness.value = roughness;
    m.specular_ior.value = ior;
    return m;
}

/// Black but for the light it sends out.
inline MaterialDesc glowing(float radiance) {
    MaterialDesc m = matte(0);
    m.emission_luminance.value = radiance * kLumensPerWatt;
    return m;
}

inline int add(SceneDesc& scene, const MaterialDesc& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

inline void place(SceneDesc& scene, ShapeKind kind, std::size_t index,
                  std::vector<Matrix34> transforms = {kIdentity34}) {
    InstanceDesc instance;
    instance.of = {kind, static_cast<int>(index)};
    instance.transforms = std::move(transforms);
    scene.instances.push_back(instance);
}

/// Quads by their corners, four points each; uvs are the unit square.
inline MeshDesc quad_mesh(const std::vector<Double3>& corners, int material) {
    MeshDesc mesh;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        mesh.positions.insert(mesh.positions.end(), corners[i].begin(), corners[i].end());
        mesh.position_index.push_back(static_cast<std::uint32_t>(i));
        mesh.uvs.insert(mesh.uvs.end(),
                        {i % 4 == 1 || i % 4 == 2 ? 1.0f : 0.0f, i % 4 >= 2 ? 1.0f : 0.0f});
    }
    mesh.quads = static_cast<std::uint32_t>(corners.size() / 4);
    mesh.materials = {material};
    return mesh;
}

/// The six faces of [-s, s]^3 around a centre, outward.
inline MeshDesc box_mesh(Double3 c, double s, int material) {
    const auto p = [&](int x, int y, int z) {
        return Double3{c[0] + x * s, c[1] + y * s, c[2] + z * s};
    };
    return quad_mesh(
        {p(-1, -1, 1),  p(1, -1, 1),  p(1, 1, 1),    p(-1, 1, 1),  p(1, -1, -1), p(-1, -1, -1),
         p(-1, 1, -1),  p(1, 1, -1),  p(1, -1, 1),   p(1, -1, -1), p(1, 1, -1),  p(1, 1, 1),
         p(-1, -1, -1), p(-1, -1, 1), p(-1, 1, 1),   p(-1, 1, -1), p(-1, 1, 1),  p(1, 1, 1),
         p(1, 1, -1),   p(-1, 1, -1), p(-1, -1, -1), p(1, -1, -1), p(1, -1, 1),  p(-1, -1, 1)},
        material);
}

/// The square [-s, s]^2 at height y, facing up.
inline MeshDesc floor_mesh(double y, double s, int material) {
    return quad_mesh({{-s, y, s}, {s, y, s}, {s, y, -s}, {-s, y, -s}}, material);
}

inline void add_mesh(SceneDesc& scene, MeshDesc mesh) {
    scene.meshes.push_back(std::move(mesh));
    place(scene, ShapeKind::mesh, scene.meshes.size() - 1);
}

inline void add_sphere(SceneDesc& scene, Double3 center, double radius, int material) {
    SphereDesc s;
    s.center = center;
    s.radius = radius;
    s.material = material;
    scene.spheres.push_back(s);
    place(scene, ShapeKind::sphere, scene.spheres.size() - 1);
}

template <class Shape>
void add_light(SceneDesc& scene, const Shape& shape, bool visible = true) {
    LightDesc light;
    light.shape = shape;
    light.visible = visible;
    scene.lights.push_back(light);
}

inline void add_sky(SceneDesc& scene, Float3 radiance) {
    scene.environment.emplace();
    scene.environment->radiance = radiance;
}

inline void set_film(SceneDesc& scene, int width, int height, int spp) {
    scene.film.width = width;
    scene.film.height = height;
    scene.film.filter = PixelFilter::box;
    scene.film.filter_width_px = 1;
    scene.render.spp = spp;
}

inline void look(SceneDesc& scene, Double3 from, Double3 at, double fov_deg = 40) {
    scene.camera.automatic = false;
    scene.camera.position = from;
    scene.camera.look_at = at;
    scene.camera.fov_deg = fov_deg;
    if (from[0] == at[0] && from[2] == at[2]) scene.camera.up = {0, 0, -1};
}

/// A parallel view of a patch so small that it is a point.
inline void look_at_point(SceneDesc& scene, Double3 from, Double3 at) {
    look(scene, from, at);
    scene.camera.projection = Projection::orthographic;
    scene.camera.ortho_height = 1e-4;
}

/// Depth limits and roulette out of the way, for scenes whose light goes on for long.
inline void without_limits(SceneDesc& scene, int depth = 1000) {
    RenderDesc& r = scene.render;
    r.max_depth = r.max_diffuse_depth = r.max_glossy_depth = r.max_transmission_depth = depth;
}

/// R, G, B, A per pixel.
inline std::vector<float> beauty_of(SceneDesc scene, const BuildOptions& build = {},
                                    const RenderSettings& settings = {}) {
    const ScenePtr built = build_scene(std::move(scene), build);
    return render(*built, settings).image.layers[0].pixels;
}

}  // namespace tessera
