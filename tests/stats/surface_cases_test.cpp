// Cases that a fresh pair of eyes found wrong, each against what it must be.

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

// Mean of the red channel over the picture.
double mean_red(const SceneDesc& scene) {
    const std::vector<float> pixels = beauty_of(scene);
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) sum += static_cast<double>(pixels[i]);
    return 4 * sum / static_cast<double>(pixels.size());
}

MaterialDesc black(float opacity) {
    MaterialDesc m = matte(0);
    m.geometry_opacity.value = opacity;
    return m;
}

}  // namespace

TEST_CASE("opacity: a ray meets both walls of a half clear sphere") {
    SceneDesc scene;
    add_sphere(scene, {0, 0, 0}, 1, add(scene, black(0.5f)));
    add_sky(scene, {1, 1, 1});
    look(scene, {0, 0, 5}, {0, 0, 0}, 10);  // the sphere fills the frame
    set_film(scene, 32, 32, 64);
    // 65536 rays: 4 sigma of a chance of a quarter.
    CHECK(std::fabs(mean_red(scene) - 0.25) < 4 * std::sqrt(0.25 * 0.75 / 65536));
}

TEST_CASE("emission: what opacity takes away gives no light, however the light is found") {
    const auto lit = [](float opacity) {
        SceneDesc scene;
        add_mesh(scene, floor_mesh(0, 5, add(scene, matte(0.5f))));
        MaterialDesc lamp = glowing(1);
        lamp.geometry_opacity.value = opacity;
        add_mesh(scene,
                 quad_mesh({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}}, add(scene, lamp)));
        look_at_point(scene, {0, 1, 1}, {0, 0, 0});
        set_film(scene, 16, 16, 256);
        return mean_red(scene);
    };
    const double full = lit(1), quarter = lit(0.25f);
    // Light sampling's noise at 65536 samples is far below 2 %.
    CHECK(quarter / full == doctest::Approx(0.25).epsilon(0.02));
}

TEST_CASE("whitted: a surface with four children at every level ends") {
    SceneDesc scene;
    MaterialDesc mixed = glass(0, 1.3f);
    mixed.geometry_thin_walled = true;
    mixed.base_metalness.value = 0.1f;
    mixed.transmission_weight.value = 0.8f;
    const int material = add(scene, mixed);
    for (int i = 0; i < 60; ++i) {
        const double z = -0.1 * i;
        add_mesh(scene, quad_mesh({{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}}, material));
    }
    add_sky(scene, {1, 1, 1});
    look(scene, {0, 0, 5}, {0, 0, 0}, 10);
    set_film(scene, 4, 4, 1);
    without_limits(scene, 64);
    scene.render.integrator = Integrator::whitted;
    const double mean = mean_red(scene);
    CHECK(mean > 0);
    CHECK(mean <= 1.001);
}
