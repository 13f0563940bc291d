// Rendered pictures whose radiance is known in closed form.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr double kPiD = 3.14159265358979323846;

// Red of every pixel over `seeds` renders of an 8x8 picture; pixels of one seed are stratified
// apart, so that their means are independent.
Mean measured(const SceneDesc& scene, int spp, int seeds = 8) {
    Mean mean;
    for (int seed = 0; seed < seeds; ++seed) {
        SceneDesc s = scene;
        set_film(s, 8, 8, spp);
        s.render.seed = static_cast<std::uint64_t>(seed);
        const auto pixels = beauty_of(std::move(s));
        for (std::size_t i = 0; i < pixels.size(); i += 4) mean.add(static_cast<double>(pixels[i]));
    }
    return mean;
}

// 4.5 sigma, and single precision.
void check_radiance(const SceneDesc& scene, int spp, double expected) {
    const Mean m = measured(scene, spp);
    CAPTURE(m.mean());
    CAPTURE(expected);
    CAPTURE(m.error());
    CHECK(std::fabs(m.mean() - expected) < 4.5 * m.error() + 3e-5 * expected);
    CHECK(m.error() <= 0.01 * expected);
}

double farthest_from_one(const SceneDesc& scene) {
    const auto pixels = beauty_of(scene);
    double worst = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (i % 4 < 3) worst = std::max(worst, std::fabs(static_cast<double>(pixels[i]) - 1));
    }
    return worst;
}

SceneDesc matte_floor(float albedo) {
    SceneDesc scene;
    add_mesh(scene, floor_mesh(0, 30, add(scene, matte(albedo))));
    look_at_point(scene, {0.6, 1, 0.7}, {0, 0, 0});
    return scene;
}

}  // namespace

TEST_CASE("closed furnace: radiance is emission over one minus albedo") {
    for (const float albedo : {0.0f, 0.5f, 0.8f}) {
        CAPTURE(albedo);
        MaterialDesc wall = matte(albedo);
        wall.emission_luminance.value = 0.3f * kLumensPerWatt;
        SceneDesc ball, box;
        add_sphere(ball, {0, 0, 0}, 1, add(ball, wall));
        add_mesh(box, box_mesh({0, 0, 0}, 1, add(box, wall)));
        for (SceneDesc* scene : {&ball, &box}) {
            look(*scene, {0.3, -0.2, 0.5}, {0, 0.1, 0}, 70);
            without_limits(*scene);
            check_radiance(*scene, 32, 0.3 / (1 - static_cast<double>(albedo)));
        }
    }
}

TEST_CASE("closed furnace: depth limits cut the series where they say") {
    // Limits of n diffuse bounces leave n + 1 terms of emission times albedo^k.
    for (const int depth : {0, 1, 3}) {
        MaterialDesc wall = matte(0.5f);
        wall.emission_luminance.value = kLumensPerWatt;
        SceneDesc scene;
        add_mesh(scene, box_mesh({0, 0, 0}, 1, add(scene, wall)));
        look(scene, {0.3, -0.2, 0.5}, {0, 0.1, 0}, 70);
        scene.render.max_diffuse_depth = depth;
        double least = 0, most = 0;
        for (int k = 0; k <= depth; ++k) least += std::pow(0.5, k);
        most = least + std::pow(0.5, depth + 1);
        const Mean m = measured(scene, 16);
        CAPTURE(depth);
        CAPTURE(m.mean());
        // Direct light at the last vertex may count as one bounce more; no more than that.
        CHECK(m.mean() > least - 4.5 * m.error() - 1e-4);
        CHECK(m.mean() < most + 4.5 * m.error() + 1e-4);
    }
}

TEST_CASE("matte floor: sphere light, sun and sky") {
    SceneDesc sphere = matte_floor(0.6f);
    add_light(sphere, SphereLightDesc{{0.5, 2, -0.4}, 0.3, {5, 5, 5}});
    const double d2 = 0.25 + 4 + 0.16;
    check_radiance(sphere, 16, 0.6 * 5 * 0.09 / d2 * 2 / std::sqrt(d2));

    for (const double angle : {0.0, 0.53, 30.0}) {
        SceneDesc sun = matte_floor(0.6f);
        add_light(sun, DistantLightDesc{{1, -2, 0.5}, {4, 4, 4}, angle});
        check_radiance(sun, 16, 0.6 / kPiD * 4 * 2 / std::sqrt(5.25));
    }
    SceneDesc sky = matte_floor(0.6f);
    add_sky(sky, {1.7f, 1.7f, 1.7f});
    check_radiance(sky, 4, 0.6 * 1.7);
}

TEST_CASE("matte floor: quad light and emissive mesh give what Lambert's formula says") {
    // Edge angles of a square of half side 1 at height 1.5 above the point, seen in full.
    const double h = 1.5, k = 1 / std::sqrt(1 + h * h);
    const double irradiance = 5 * 4 * k * std::atan(k);
    SceneDesc quad = matte_floor(0.6f);
    QuadLightDesc light;
    light.corner = {-1, h, -1};
    light.edges = {Double3{2, 0, 0}, Double3{0, 0, 2}};
    light.radiance = {5, 5, 5};
    add_light(quad, light);
    check_radiance(quad, 32, 0.6 / kPiD * irradiance);

    SceneDesc mesh = matte_floor(0.6f);
    add_mesh(mesh,
             quad_mesh({{-1, h, -1}, {1, h, -1}, {1, h, 1}, {-1, h, 1}}, add(mesh, glowing(5))));
    check_radiance(mesh, 64, 0.6 / kPiD * irradiance);
}

TEST_CASE("open furnace: white things in even light cannot be seen") {
    SceneDesc scene;
    const int white = add(scene, matte(1));
    add_sphere(scene, {0, 0, 0}, 1, white);
    add_sphere(scene, {1.6, 0.3, 0}, 0.7, white);
    add_mesh(scene, box_mesh({-1.5, 0.2, 0.4}, 0.6, white));
    add_sky(scene, {1, 1, 1});
    look(scene, {0.4, 0.8, 5}, {0, 0, 0}, 35);
    without_limits(scene, 10000);
    set_film(scene, 32, 32, 16);
    CHECK(farthest_from_one(scene) < 1e-4);
}

TEST_CASE("glass in even light: smooth glass cannot be seen, rough glass loses a little") {
    for (const bool whitted : {false, true}) {
        SceneDesc scene;
        add_sphere(scene, {0, 0, 0}, 1, add(scene, glass(0)));
        add_sky(scene, {1, 1, 1});
        look(scene, {0, 0.5, 5}, {0, 0, 0}, 30);
        without_limits(scene, whitted ? 60 : 200);
        if (whitted) scene.render.integrator = Integrator::whitted;
        set_film(scene, 32, 32, 8);
        // The ray tree leaves out branches of less than 1e-4.
        CHECK(farthest_from_one(scene) < (whitted ? 2e-3 : 1e-4));
    }
    for (const float roughness : {0.2f, 0.5f, 1.0f}) {
        CAPTURE(roughness);
        SceneDesc scene;
        add_sphere(scene, {0, 0, 0}, 1, add(scene, glass(roughness)));
        add_sky(scene, {1, 1, 1});
        look(scene, {0, 0.5, 5}, {0, 0, 0}, 20);
        without_limits(scene, 200);
        const Mean m = measured(scene, 64, 2);
        CHECK(m.mean() < 1 + 4.5 * m.error());
        CHECK(m.mean() > (roughness < 0.3f ? 0.95 : 0.3));
    }
}

TEST_CASE("whitted: a mirror shows the sky, a matte floor gets light by its cosine") {
    SceneDesc mirror;
    add_mesh(mirror, floor_mesh(0, 10, add(mirror, metal(0))));
    add_sky(mirror, {0.7f, 0.7f, 0.7f});
    look(mirror, {0, 1, 0.5}, {0, 0, 0});
    mirror.render.integrator = Integrator::whitted;
    check_radiance(mirror, 1, 0.7);

    SceneDesc lit = matte_floor(0.5f);
    add_light(lit, PointLightDesc{{0, 2, 1}, {6, 6, 6}});
    lit.render.integrator = Integrator::whitted;
    check_radiance(lit, 1, 0.5 / kPiD * 6 / 5 * 2 / std::sqrt(5));
}

TEST_CASE(
    "alpha cut-outs: half opacity lets half of the light through, to the eye and in shadows") {
    SceneDesc seen;
    MaterialDesc card = matte(0);
    card.geometry_opacity.value = 0.5f;
    add_mesh(seen, quad_mesh({{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}, add(seen, card)));
    add_sky(seen, {2, 2, 2});
    look(seen, {0, 0, 3}, {0, 0, 0});
    check_radiance(seen, 256, 1);

    for (const bool whitted : {false, true}) {
        SceneDesc shadow = matte_floor(0.5f);
        card.geometry_opacity.value = 0.3f;
        add_mesh(shadow, floor_mesh(1.5, 0.5, add(shadow, card)));
        add_light(shadow, PointLightDesc{{0, 3, 0}, {9, 9, 9}});
        if (whitted) shadow.render.integrator = Integrator::whitted;
        check_radiance(shadow, 256, 0.5 / kPiD * 0.7);
    }
}

TEST_CASE("many lights: the picture is the sum of the pictures of each") {
    const auto scene = [](int which) {
        SceneDesc s = matte_floor(0.5f);
        if (which & 1) add_light(s, SphereLightDesc{{1, 2, 0}, 0.4, {3, 3, 3}});
        if (which & 2) add_light(s, PointLightDesc{{-1, 2, 0}, {1, 1, 1}});
        if (which & 4) add_light(s, DistantLightDesc{{0, -1, 0.3}, {0.2f, 0.2f, 0.2f}, 10});
        if (which & 8) add_sky(s, {0.1f, 0.1f, 0.1f});
        return s;
    };
    const Mean all = measured(scene(15), 64);
    double sum = 0, variance = all.error() * all.error();
    for (const int which : {1, 2, 4, 8}) {
        const Mean one = measured(scene(which), 16);
        sum += one.mean(), variance += one.error() * one.error();
    }
    sum -= 0.5 * 0.1 * 0.16 / 5 * 2 / std::sqrt(5);  // the sky that the sphere hides
    CHECK(std::fabs(all.mean() - sum) < 4.5 * std::sqrt(variance) + 1e-4 * sum);
}
