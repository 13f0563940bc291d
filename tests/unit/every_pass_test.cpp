// RenderSettings::on_pass
#include <doctest/doctest.h>

#include <chrono>
#include <thread>

#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

ScenePtr scene(int spp) {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 4, add(s, matte(0.7f))));
    add_sphere(s, {0, 0.5, 0}, 0.5, add(s, metal(0.2f)));
    add_sky(s, {0.3f, 0.4f, 0.5f});
    look(s, {0, 1.6, 5}, {0, 0.6, 0}, 45);
    set_film(s, 37, 22, spp);
    s.film.aovs = {"beauty"};
    return build_scene(std::move(s));
}

}  // namespace

TEST_CASE("every pass: each is the picture that so many samples make, and the last is the whole") {
    std::vector<RenderResult> passes;
    RenderSettings settings;
    settings.on_pass = [&](RenderResult&& r) { passes.push_back(std::move(r)); };
    const RenderResult whole = render(*scene(24), settings);
    std::vector<int> spp;
    for (const RenderResult& r : passes) spp.push_back(r.stats.spp);
    REQUIRE(spp == std::vector<int>{1, 2, 4, 8, 16, 24});
    for (const RenderResult& r : passes) {
        CAPTURE(r.stats.spp);
        CHECK(r.image.layers.at(0).pixels == render(*scene(r.stats.spp)).image.layers.at(0).pixels);
    }
    CHECK(passes.back().image.layers.at(0).pixels == whole.image.layers.at(0).pixels);
    CHECK(passes.back().stats.rays.total() == whole.stats.rays.total());
}

TEST_CASE("every pass: what is done with the pictures is in no time") {
    constexpr std::chrono::milliseconds kPause{150};
    int passes = 0;
    RenderSettings settings;
    settings.on_pass = [&](RenderResult&&) {
        ++passes;
        std::this_thread::sleep_for(kPause);
    };
    const ScenePtr s = scene(8);
    const auto start = std::chrono::steady_clock::now();
    const RenderResult r = render(*s, settings);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    const double paused = std::chrono::duration<double>(kPause).count() * passes;
    REQUIRE(passes == 4);
    CHECK(wall.count() > paused);
    // A clock that stood still meanwhile lacks all of it.
    CHECK(r.stats.render_s <= wall.count() - paused);
    CHECK(r.stats.error_curve.back().wall_s <= wall.count() - paused);
}
