// Renders of 48x48 pixels against stored means and variances. Where the renders at hand scatter
// more than the stored ones did, their own variance counts: noise may change with the sampling,
// light may not. The references in tests/image were written by this program run with
// TESSERA_WRITE_REFERENCES=1; they change only when the light in a scene is meant to change.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <functional>

#include "tests/support/picture_statistics.h"

using namespace tessera;

namespace {

constexpr double kAlphaOfSuite = 0.01;  // over all blocks of all scenes
constexpr int kSeeds = 6;
constexpr int kReferenceSeeds = 256;
constexpr std::size_t kBlocks = 12 * 12 * 3;

MaterialDesc coloured(MaterialDesc m, Float3 color) {
    m.base_color.value = color;
    return m;
}

QuadLightDesc quad_light(Double3 corner, Double3 u, Double3 v, Float3 radiance) {
    QuadLightDesc q;
    q.corner = corner;
    q.edges = {u, v};
    q.radiance = radiance;
    return q;
}

SceneDesc room() {
    SceneDesc s;
    const int white = add(s, matte(0.7f)), red = add(s, coloured(matte(1), {0.6f, 0.1f, 0.1f})),
              green = add(s, coloured(matte(1), {0.1f, 0.5f, 0.1f}));
    add_mesh(s, floor_mesh(0, 1, white));
    add_mesh(s, quad_mesh({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, white));
    add_mesh(s, quad_mesh({{-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1}}, white));
    add_mesh(s, quad_mesh({{-1, 0, 1}, {-1, 0, -1}, {-1, 2, -1}, {-1, 2, 1}}, red));
    add_mesh(s, quad_mesh({{1, 0, -1}, {1, 0, 1}, {1, 2, 1}, {1, 2, -1}}, green));
    add_mesh(s, box_mesh({-0.4, 0.35, -0.2}, 0.35, white));
    add_light(s, quad_light({-0.3, 1.98, -0.3}, {0.6, 0, 0}, {0, 0, 0.6}, {12, 11, 9}));
    look(s, {0, 1, 4}, {0, 1, 0}, 35);
    return s;
}

SceneDesc plates() {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 4, add(s, matte(0.4f))));
    const float roughness[] = {0.15f, 0.3f, 0.6f};
    for (int i = 0; i < 3; ++i) {
        const double y = 0.3 + 0.5 * i, z = -0.8 * i;
        add_mesh(s,
                 quad_mesh({{-2, y, z + 0.5}, {2, y, z + 0.5}, {2, y + 0.35, z}, {-2, y + 0.35, z}},
                           add(s, metal(roughness[i], 0.9f))));
    }
    add_light(s, SphereLightDesc{{-1.2, 2.8, -1}, 0.1, {60, 50, 40}});
    add_light(s, SphereLightDesc{{0.2, 2.8, -1}, 0.3, {6, 8, 9}});
    add_light(s, SphereLightDesc{{1.6, 2.8, -1}, 0.6, {2, 2, 3}});
    look(s, {0, 2, 6}, {0, 1.2, 0}, 40);
    return s;
}

SceneDesc plastics() {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 5, add(s, matte(0.5f))));
    for (int i = 0; i < 3; ++i) {
        MaterialDesc m = coloured(matte(1), {0.2f + 0.3f * static_cast<float>(i), 0.5f,
                                             0.7f - 0.3f * static_cast<float>(i)});
        m.specular_weight.value = 1;
        m.specular_roughness.value = 0.2f + 0.3f * static_cast<float>(i);
        m.base_metalness.value = i == 1 ? 0.5f : 0.0f;
        m.specular_roughness_anisotropy.value = i == 2 ? 0.6f : 0.0f;
        add_sphere(s, {-1.3 + 1.3 * i, 0.6, 0}, 0.6, add(s, m));
    }
    add_light(s, DistantLightDesc{{-1, -2, -1}, {2, 1.8f, 1.5f}, 40});
    add_sky(s, {0.3f, 0.4f, 0.6f});
    look(s, {0, 1.4, 5}, {0, 0.5, 0}, 40);
    return s;
}

SceneDesc glasses() {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 5, add(s, matte(0.6f))));
    add_sphere(s, {-0.8, 0.7, 0}, 0.7, add(s, glass(0)));
    add_sphere(s, {0.9, 0.6, 0.2}, 0.6, add(s, glass(0.4f)));
    MaterialDesc pane = glass(0);
    pane.geometry_thin_walled = true;
    add_mesh(
        s, quad_mesh({{-0.3, 0, 1}, {0.6, 0, 1.3}, {0.6, 1.5, 1.3}, {-0.3, 1.5, 1}}, add(s, pane)));
    add_light(s, DiscLightDesc{{0, 3, 1}, {0, -1, 0}, 0.9, {5, 5, 5}, false});
    add_sky(s, {0.5f, 0.6f, 0.7f});
    look(s, {0.3, 1.3, 5}, {0, 0.6, 0}, 36);
    return s;
}

SceneDesc leaves() {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 4, add(s, matte(0.7f))));
    MaterialDesc leaf = coloured(matte(1), {0.2f, 0.6f, 0.1f});
    leaf.geometry_opacity.value = 0.6f;
    s.meshes.push_back(
        quad_mesh({{-0.5, 0, 0}, {0.5, 0, 0}, {0.5, 1, 0.2}, {-0.5, 1, 0}}, add(s, leaf)));
    std::vector<Matrix34> places;
    for (int i = 0; i < 9; ++i)
        places.push_back({i % 2 ? -1.0 : 1.0, 0.1 * i, 0.2, 0.7 * (i % 3) - 0.7, 0, 0.6 + 0.1 * i,
                          0, 0, 0, 0.05 * i, 0.9, 0.6 * (i / 3) - 0.6});
    place(s, ShapeKind::mesh, s.meshes.size() - 1, places);
    SpotLightDesc spot;
    spot.position = {1.5, 4, 2};
    spot.direction = {-1.5, -4, -2};
    spot.intensity = {40, 40, 35};
    spot.cone_deg = 28;
    add_light(s, spot);
    add_light(s, PointLightDesc{{-2, 2, 2}, {3, 4, 6}});
    look(s, {0.5, 1.6, 4.5}, {0, 0.5, 0}, 36);
    s.camera.aperture_radius = 0.05;
    return s;
}

SceneDesc ray_tree() {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 5, add(s, coloured(matte(1), {0.8f, 0.7f, 0.2f}))));
    add_sphere(s, {-0.6, 1, 0.2}, 0.7, add(s, glass(0)));
    add_sphere(s, {0.7, 0.7, -0.5}, 0.7, add(s, metal(0, 0.8f)));
    add_light(s, quad_light({-2, 4, 0}, {1, 0, 0}, {0, 0, 1}, {20, 20, 20}));
    add_light(s, PointLightDesc{{2, 3, 3}, {8, 8, 9}});
    add_sky(s, {0.2f, 0.3f, 0.5f});
    look(s, {0, 1.4, 5}, {0, 0.8, 0}, 36);
    s.render.integrator = Integrator::whitted;
    return s;
}

struct Reference {
    const char* name;
    SceneDesc (*make)();
};

constexpr Reference kReferences[] = {{"room", room},         {"plates", plates},
                                     {"plastics", plastics}, {"glasses", glasses},
                                     {"leaves", leaves},     {"ray_tree", ray_tree}};

SceneDesc scene_of(const Reference& r) {
    SceneDesc s = r.make();
    set_film(s, 48, 48, 16);
    return s;
}

std::string path_of(const Reference& r) {
    return fmt::format("{}/tests/image/{}.ref", TESSERA_SOURCE_DIR, r.name);
}

// One line per block and channel: mean, variance of the picture of one seed.
void write_reference(const Reference& r) {
    const BlockStatistics s = block_statistics(scene_of(r), 1u << 20, kReferenceSeeds);
    std::ofstream out(path_of(r));
    out << fmt::format(
        "# {}: 48x48, 16 samples, {} seeds; mean and variance of each 4x4 block and channel\n",
        r.name, kReferenceSeeds);
    for (const Mean& m : s.values) out << fmt::format("{:.7g} {:.4g}\n", m.mean(), m.variance());
}

std::string difference(const Reference& r, double brighter) {
    std::ifstream in(path_of(r));
    std::string line;
    if (!std::getline(in, line)) return fmt::format("{}: no reference\n", r.name);
    const BlockStatistics s = block_statistics(scene_of(r), 7, kSeeds);
    const double level = sidak_level(kAlphaOfSuite, kBlocks * std::size(kReferences));
    std::string worst;
    double least = level;
    for (std::size_t i = 0; i < s.values.size(); ++i) {
        double mean = 0, variance = 0;
        if (!(in >> mean >> variance))
            return fmt::format("{}: the reference is too short\n", r.name);
        const double p =
            same_mean_p(s.values[i].mean() * brighter,
                        std::sqrt(std::max(variance, s.values[i].variance()) / kSeeds), mean,
                        std::sqrt(variance / kReferenceSeeds), kReferenceSeeds - 1);
        if (p >= least) continue;
        least = p;
        worst = fmt::format("{}: block {},{} channel {}: {:.6f}, reference {:.6f}, p = {:.1e}\n",
                            r.name, i / 3 % 12, i / 36, i % 3, s.values[i].mean(), mean, p);
    }
    return worst;
}

}  // namespace

TEST_CASE("references: small pictures have the stored mean, by z-test") {
    if (std::getenv("TESSERA_WRITE_REFERENCES")) {
        for (const Reference& r : kReferences) write_reference(r);
        MESSAGE("references written, nothing compared");
        return;
    }
    std::string all;
    for (const Reference& r : kReferences) all += difference(r, 1);
    CHECK(all == "");
}

TEST_CASE("references: the z-test sees two percent too much light in any of them") {
    if (std::getenv("TESSERA_WRITE_REFERENCES")) return;
    for (const Reference& r : kReferences) {
        CAPTURE(r.name);
        CHECK(difference(r, 1.02) != "");
    }
}
