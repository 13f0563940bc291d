#include <doctest/doctest.h>

#include <cmath>

#include "renderer/api/deep.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr int kSize = 40;

// A floor that reaches far, a ball before another.
SceneDesc balls(const MaterialDesc& front) {
    SceneDesc scene;
    set_film(scene, kSize, kSize, 16);
    look(scene, {0, 1.5, 6}, {0, 0.5, 0});
    add_mesh(scene, floor_mesh(-0.5, 30, add(scene, matte(0.6f))));
    add_sphere(scene, {0.4, 0.5, -2}, 1.2, add(scene, matte(0.3f)));
    add_sphere(scene, {-0.4, 0.4, 1}, 0.7, add(scene, front));
    add_sky(scene, {0.5f, 0.7f, 3.0f});
    return scene;
}

MaterialDesc veil(float opacity) {
    MaterialDesc m = matte(0.8f);
    m.geometry_opacity.value = opacity;
    return m;
}

RenderResult render_deep(SceneDesc scene, RenderSettings settings = {}) {
    scene.film.aovs = {"Z"};
    const ScenePtr built = build_scene(std::move(scene));
    settings.deep = true;
    return render(*built, settings);
}

LayeredImage flat_of(const RenderResult& r, bool all_float) {
    const TempFolder folder;
    WriteOptions options;
    options.all_float = all_float;
    write_deep_exr(*r.deep, r.image.window, folder / "d.exr", options);
    const std::vector<std::string> paths{folder / "d.exr"};
    return flatten_deep_exr(paths);
}

// The worst difference of any channel of any pixel from beauty, relative to what is above 1.
double worst(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double want = static_cast<double>(b[i]);
        most = std::max(most, std::fabs(static_cast<double>(a[i]) - want) / std::max(want, 1.0));
    }
    return most;
}

double mean_samples(const DeepImage& deep) {
    return static_cast<double>(deep.samples.size()) / static_cast<double>(deep.counts.size());
}

void check_beauty(const SceneDesc& scene) {
    const RenderResult r = render_deep(scene);
    REQUIRE(r.deep);
    CHECK(mean_samples(*r.deep) > 1.2);  // there are edges
    const LayeredImage exact = flat_of(r, true), halves = flat_of(r, false);
    CHECK(worst(exact.layers[0].pixels, r.image.layers[0].pixels) < 1e-6);
    CHECK(worst(halves.layers[0].pixels, r.image.layers[0].pixels) < 0x1p-11);
    CHECK(exact.layers[1].pixels == r.image.layers[1].pixels);  // Z
}

// A glowing ball and square of even colour, each twice as far away as the other is large.
SceneDesc glow(bool near, bool far) {
    SceneDesc scene;
    set_film(scene, kSize, kSize, 16);
    look(scene, {0, 0, 6}, {0, 0, 0});
    const int a = add(scene, glowing(3)), b = add(scene, glowing(0.5f));
    if (near) add_sphere(scene, {0.1, 0.2, 1}, 0.6, a);
    if (far)
        add_mesh(
            scene,
            quad_mesh({{-1.3, -1.2, -1}, {1.4, -1.2, -1}, {1.4, 1.3, -1}, {-1.3, 1.3, -1}}, b));
    return scene;
}

}  // namespace

TEST_CASE("deep render: flattened it is beauty, with edges and background") {
    check_beauty(balls(matte(0.5f)));
}

TEST_CASE("deep render: flattened it is beauty, with cut-outs") { check_beauty(balls(veil(0.4f))); }

TEST_CASE("deep render: flattened it is beauty, with glass") { check_beauty(balls(glass(0))); }

TEST_CASE("deep render: flattened it is beauty, out of focus") {
    SceneDesc scene = balls(matte(0.5f));
    scene.camera.aperture_radius = 0.2;
    scene.camera.focus_distance = 5;
    check_beauty(scene);
}

TEST_CASE("deep render: beauty and passes keep their bits") {
    SceneDesc scene = balls(veil(0.5f));
    const RenderResult deep = render_deep(scene);
    scene.film.aovs = {"Z"};
    const RenderResult plain = render(*build_scene(std::move(scene)), {});
    CHECK(!plain.deep);
    for (std::size_t l = 0; l < plain.image.layers.size(); ++l)
        CHECK(plain.image.layers[l].pixels == deep.image.layers[l].pixels);
}

TEST_CASE("deep render: it asks for no pass") {
    SceneDesc scene = balls(matte(0.5f));
    scene.film.aovs = {"beauty"};
    RenderSettings settings;
    settings.deep = true;
    const RenderResult r = render(*build_scene(std::move(scene)), settings);
    REQUIRE(r.image.layers.size() == 1);
    CHECK(worst(flat_of(r, true).layers[0].pixels, r.image.layers[0].pixels) < 1e-6);
}

TEST_CASE("deep render: threads and tiles leave its bits alone") {
    RenderSettings other;
    other.threads = 1;
    other.tile = 8;
    const RenderResult a = render_deep(balls(veil(0.4f))),
                       b = render_deep(balls(veil(0.4f)), other);
    CHECK(a.deep->counts == b.deep->counts);
    CHECK(a.deep->samples == b.deep->samples);
}

TEST_CASE("deep render: two halves of a scene merge into the whole") {
    const TempFolder folder;
    WriteOptions options;
    options.all_float = true;
    const PixelWindow all{0, 0, kSize, kSize};
    write_deep_exr(*render_deep(glow(true, false)).deep, all, folder / "near.exr", options);
    write_deep_exr(*render_deep(glow(false, true)).deep, all, folder / "far.exr", options);
    const RenderResult whole = render_deep(glow(true, true));
    for (const bool swapped : {false, true}) {
        std::vector<std::string> paths{folder / "near.exr", folder / "far.exr"};
        if (swapped) std::swap(paths[0], paths[1]);
        const LayeredImage merged = flatten_deep_exr(paths);
        // No pixel has the edges of both, and the square's colour is even: nothing depends on which
        // of its samples the ball hides.
        CHECK(worst(merged.layers[0].pixels, whole.image.layers[0].pixels) < 1e-6);
        CHECK(merged.layers[1].pixels == whole.image.layers[1].pixels);
    }
    CHECK(worst(whole.image.layers[0].pixels,
                render_deep(glow(false, true)).image.layers[0].pixels) > 0.1);
}
