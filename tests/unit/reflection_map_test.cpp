// Local reflection maps: what is read, and where in the map a reflected ray looks.
#include <doctest/doctest.h>

#include <cmath>

#include "renderer/lights/reflection_map.h"
#include "tests/support/map_files.h"
#include "tests/support/random.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

// A map whose colours are its directions.
LatLongMap directions() {
    constexpr int kHeight = 256;
    std::vector<Color> texels;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < 2 * kHeight; ++x)
            texels.push_back(latlong_direction({(static_cast<float>(x) + 0.5f) / (2 * kHeight),
                                                (static_cast<float>(y) + 0.5f) / kHeight}));
    }
    return make_latlong_map(2 * kHeight, kHeight, std::move(texels), Color(1.0f), 0);
}

// Bilinear between texels of 0.012 rad, whose chords miss the sphere by 2e-5.
constexpr double kTexel = 1e-3;

constexpr const char* kBall = "[[sphere]]\nmaterial = 'm'\n";

SceneDesc ball_scene(const SceneFolder& folder, const std::string& material) {
    SceneDesc scene = folder.load(kBall + std::string("[material.m]\n") + material);
    look(scene, {0, 0, 6}, {0, 0, 0}, 12);
    set_film(scene, 8, 8, 64);
    return scene;
}

}  // namespace

TEST_CASE("reflection map: with no walls the direction is looked up as it is") {
    const ReflectionMap map(directions());
    Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d d = random.direction();
        REQUIRE(length(Vec3d(map.seen({9, -4, 3}, Vec3f(d))) - d) < kTexel);
    }
}

TEST_CASE("reflection map: a ray sees what lies where it meets the sphere or the box") {
    const Vec3d taken{1, 2, -1}, lo{-3, 0, -6}, hi{4, 5, 2};
    ReflectionMap sphere(directions()), box(directions());
    sphere.show_sphere(Vec3f(taken), 7);
    box.show_box(Vec3f(taken), Vec3f(lo), Vec3f(hi));
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        // Walked backward: from a point on the wall to where the ray began.
        const Vec3d on_sphere = taken + random.direction() * 7.0;
        const Vec3d p{random.between(-2, 3), random.between(1, 4), random.between(-5, 1)};
        Vec3d on_box{random.between(-3, 4), random.between(0, 5), random.between(-6, 2)};
        const int axis = i % 3;
        (axis == 0 ? on_box.x : axis == 1 ? on_box.y : on_box.z) = (i & 8 ? lo : hi)[axis];
        REQUIRE(length(Vec3d(sphere.seen(Vec3f(p), Vec3f(normalize(on_sphere - p)))) -
                       normalize(on_sphere - taken)) < kTexel);
        REQUIRE(length(Vec3d(box.seen(Vec3f(p), Vec3f(normalize(on_box - p)))) -
                       normalize(on_box - taken)) < kTexel);
    }
}

TEST_CASE("reflection map: rays that meet no wall see what is infinitely far") {
    ReflectionMap sphere(directions()), box(directions());
    sphere.show_sphere({0, 0, 0}, 1);
    box.show_box({0, 0, 0}, {-1, -1, -1}, {1, 1, 1});
    const Vec3f away = normalize(Vec3f{1, 0.2f, 0.1f});
    CHECK(length(sphere.seen({5, 0, 0}, away) - away) < 1e-3f);
    CHECK(length(box.seen({5, 0, 0}, away) - away) < 1e-3f);
    const Vec3f past{0, 0.6f, 0.8f};
    CHECK(length(sphere.seen({5, 0, 0}, past) - past) < 1e-3f);
}

TEST_CASE("reflection map: a mirror shows the map's light, not the scene's") {
    const SceneFolder folder;
    write_map(folder.path("one.exr"), Color{1, 0.5f, 0.25f});
    for (const char* roughness : {"0", "0.001", "0.4"}) {
        SceneDesc scene =
            ball_scene(folder,
                       "base_metalness = 1\nbase_color = 1\nreflection_map = { file = 'one.exr' }\n"
                       "specular_roughness = " +
                           std::string(roughness));
        add_sky(scene, {7, 7, 7});
        QuadLightDesc lamp;
        lamp.corner = {-1, 3, -1};
        lamp.radiance = {50, 50, 50};
        add_light(scene, lamp, false);
        const auto pixels = beauty_of(std::move(scene));
        const std::size_t middle = 4 * (8 * 4 + 4);
        CAPTURE(roughness);
        // The tables of energy among the microfacets are good to half a percent.
        CHECK(pixels[middle] == doctest::Approx(1).epsilon(0.01));
        CHECK(pixels[middle + 1] == doctest::Approx(0.5).epsilon(0.01));
        CHECK(pixels[middle + 2] == doctest::Approx(0.25).epsilon(0.01));
    }
}

TEST_CASE("reflection map: a mirror ball in a closed white furnace is as white as the furnace") {
    const SceneFolder folder;
    write_map(folder.path("one.exr"), Color(1.0f));
    SceneDesc scene = ball_scene(folder,
                                 "base_metalness = 1\nbase_color = 1\nspecular_roughness = 0\n"
                                 "reflection_map = { file = 'one.exr' }");
    add_mesh(scene, box_mesh({0, 0, 0}, 10, add(scene, glowing(1))));
    for (const Integrator integrator : {Integrator::path, Integrator::whitted}) {
        scene.render.integrator = integrator;
        for (const float p : beauty_of(scene)) REQUIRE(p == doctest::Approx(1).epsilon(1e-4));
    }
}

TEST_CASE("reflection map: what does not reflect goes on as ever") {
    const SceneFolder folder;
    write_map(folder.path("bright.exr"), Color(100.0f));
    const std::string map = "reflection_map = { file = 'bright.exr' }\n";
    for (const std::string& material :
         {std::string("specular_weight = 0\nbase_color = 0.5\n"),
          std::string("specular_weight = 0\nbase_diffuse_roughness = 1\nfuzz_weight = 0.5\n"),
          std::string("specular_weight = 0\nsubsurface_weight = 1\nsubsurface_radius = 0.2\n")}) {
        SceneDesc without = ball_scene(folder, material), with = ball_scene(folder, material + map);
        for (SceneDesc* s : {&without, &with}) {
            add_sky(*s, {1, 1, 1});
            DistantLightDesc sun;
            sun.irradiance = {3, 3, 3};
            add_light(*s, sun);
            set_film(*s, 8, 8, 4);
        }
        const auto a = beauty_of(std::move(without)), b = beauty_of(std::move(with));
        CAPTURE(material);
        // The same paths; sums of lobes in another order.
        for (std::size_t i = 0; i < a.size(); ++i)
            REQUIRE(b[i] == doctest::Approx(a[i]).epsilon(1e-4));
    }
}

TEST_CASE("reflection map: wrong ones are errors at their place") {
    const SceneFolder folder;
    write_map(folder.path("one.exr"), Color(1.0f));
    const auto failure = [&](const std::string& map) {
        const std::string text = kBall + std::string("[material.m]\nreflection_map = ") + map;
        const std::string loading = folder.failure(text);
        if (!loading.empty()) return loading;
        try {
            build_scene(folder.load(text));
        } catch (const Error& e) {
            CHECK(e.code() == ExitCode::scene);
            return std::string(e.what());
        }
        return std::string();
    };
    const auto says = [&](const std::string& map, const std::string& what) {
        const std::string message = failure(map);
        CAPTURE(message);
        CHECK(message.find(what) != std::string::npos);
    };
    CHECK(failure("{ file = 'one.exr' }") == "");
    CHECK(failure("{ file = 'one.exr', position = [0, 0, 0], radius = 2 }") == "");
    says("3", "s.toml:5:1: material 'm': reflection_map");
    says("{ scale = 2 }", "s.toml:5:18: material 'm': reflection_map: key 'file' is missing");
    says("{ file = 'none.exr' }", "s.toml:5:20: material 'm': reflection_map: file 'none.exr'");
    says("{ file = 'one.exr', radius = 2 }", "s.toml:5:38: material 'm': reflection_map: radius");
    says("{ file = 'one.exr', radius = 0 }", "radius is 0");
    says("{ file = 'one.exr', sphere = 2 }", "unknown key 'sphere'");
    says("{ file = 'one.exr', position = [0,0,0], box = [[0,0,0],[1,0,1]] }", "the box is flat");
    says("{ file = 'one.exr', position = [0,0,0], radius = 1, box = [[0,0,0],[1,1,1]] }",
         "both say where the walls are");
    says("{ file = 'one.exr', projection = 'angular' }",
         "s.toml:5:20: material 'm': reflection_map: file '");
    folder.write("text.exr", "no picture");
    says("{ file = 'text.exr' }", "s.toml:5:20: material 'm': reflection_map: file: image '");
}
