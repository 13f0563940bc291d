// The picture is a function of scene, settings and seed alone: not of kernel, threads, tiles or
// crop.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <bit>

#include "renderer/scene/scene.h"
#include "tests/support/temp_folder.h"
#include "tests/support/test_scenes.h"
#include "tests/support/tiff.h"

using namespace tessera;

namespace {

// Every float of every layer, by its bits.
std::vector<std::uint32_t> bits_of(const RenderResult& result) {
    std::vector<std::uint32_t> bits;
    for (const Layer& layer : result.image.layers) {
        for (const float p : layer.pixels) bits.push_back(std::bit_cast<std::uint32_t>(p));
    }
    return bits;
}

std::vector<std::uint32_t> rendered(SceneDesc scene, const BuildOptions& build = {},
                                    const RenderSettings& settings = {}) {
    return bits_of(render(*build_scene(std::move(scene), build), settings));
}

std::vector<std::uint32_t> by_kernel(SceneDesc scene, const std::string& kernel) {
    BuildOptions build;
    build.kernel = kernel;
    return rendered(std::move(scene), build);
}

std::vector<std::uint32_t> by_schedule(SceneDesc scene, int threads, int tile) {
    BuildOptions build;
    build.threads = threads;
    RenderSettings settings;
    settings.threads = threads;
    settings.tile = tile;
    return rendered(std::move(scene), build, settings);
}

SceneDesc matte_scene() {
    SceneDesc s;
    add_mesh(s, floor_mesh(0, 4, add(s, matte(0.7f))));
    add_mesh(s, box_mesh({0.4, 0.7, 0}, 0.6, add(s, matte(0.4f))));
    QuadLightDesc light;
    light.corner = {-1, 3, -1};
    light.edges = {Double3{2, 0, 0}, Double3{0, 0, 2}};
    light.radiance = {9, 8, 7};
    add_light(s, light);
    add_sky(s, {0.2f, 0.3f, 0.5f});
    look(s, {2, 2.5, 5}, {0, 0.5, 0});
    set_film(s, 44, 36, 4);
    s.film.filter = PixelFilter::blackman_harris;
    s.film.filter_width_px = 3;
    return s;
}

SceneDesc shiny_scene(const TempFolder& folder) {
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 16 * 16; ++i) {
        const bool dark = (i / 4 + i / 64) % 2;
        texels.insert(texels.end(), {std::uint8_t(dark ? 40 : 230), std::uint8_t(dark ? 90 : 200),
                                     std::uint8_t(120)});
    }
    write_tiff<std::uint8_t>(folder / "tiles.tif", 16, 16, 3, 0, texels);
    SceneDesc s = matte_scene();
    TextureDesc texture;
    texture.file = folder / "tiles.tif";
    s.textures.push_back(texture);
    MaterialDesc tiles = matte(1);
    tiles.base_color.texture = 0;
    tiles.specular_weight.value = 1;
    s.materials[0] = tiles;
    add_sphere(s, {-1.2, 0.6, 0.4}, 0.6, add(s, metal(0.2f, 0.9f)));
    const int leaf = static_cast<int>(s.meshes.size());
    MaterialDesc cutout = matte(0.5f);
    cutout.geometry_opacity.value = 0.4f;
    s.meshes.push_back(
        quad_mesh({{-0.4, 0, 0}, {0.4, 0, 0}, {0.4, 0.8, 0.2}, {-0.4, 0.8, 0}}, add(s, cutout)));
    place(s, ShapeKind::mesh, std::size_t(leaf),
          {Matrix34{1, 0.2, 0, -1, 0, 1, 0, 0, 0, 0, -1, 1.5},
           Matrix34{0, 0, 1, 1.4, 0, 2, 0, 0, -1, 0, 0, 1}});
    add_light(s, SphereLightDesc{{2, 2, 2}, 0.2, {6, 6, 6}});
    return s;
}

/// Colour and opacity by drawn texels.
SceneDesc stochastic_scene(const TempFolder& folder) {
    SceneDesc s = shiny_scene(folder);
    s.textures[0].filter = TextureFilter::stochastic;
    s.textures[0].scale = {3.3f, 2.1f};
    MaterialDesc sheet = matte(1);
    sheet.base_color.texture = 0;
    sheet.geometry_opacity.texture = 0;
    add_mesh(s, box_mesh({-0.3, 0.6, 1.4}, 0.5, add(s, sheet)));
    return s;
}

SceneDesc glass_scene(const TempFolder& folder) {
    SceneDesc s = shiny_scene(folder);
    add_sphere(s, {0.9, 0.5, 1.5}, 0.5, add(s, glass(0)));
    add_sphere(s, {-0.4, 0.35, 1.9}, 0.35, add(s, glass(0.3f, 1.3f)));
    s.camera.aperture_radius = 0.03;
    s.camera.focus_distance = 5;
    return s;
}

void check_schedules(const SceneDesc& scene) {
    const auto reference = by_schedule(scene, 1, 32);
    CHECK(by_schedule(scene, 2, 4) == reference);
    CHECK(by_schedule(scene, 3, 16) == reference);
    CHECK(by_schedule(scene, 3, 64) == reference);
    SceneDesc other = scene;
    other.render.seed = 1;
    CHECK(rendered(other) != reference);
}

void check_crops(const SceneDesc& scene) {
    const RenderResult full = render(*build_scene(SceneDesc(scene)));
    for (const PixelWindow window : {PixelWindow{0, 0, 44, 36}, PixelWindow{7, 5, 30, 29},
                                     PixelWindow{43, 35, 44, 36}, PixelWindow{1, 0, 2, 36}}) {
        SceneDesc cropped = scene;
        cropped.film.crop = window;
        RenderSettings settings;
        settings.tile = 8;
        const RenderResult part = render(*build_scene(std::move(cropped)), settings);
        REQUIRE(part.image.layers.size() == full.image.layers.size());
        int different = 0;
        for (std::size_t l = 0; l < full.image.layers.size(); ++l) {
            const Layer &a = full.image.layers[l], &b = part.image.layers[l];
            const std::size_t channels = a.channels.size();
            for (int y = window.y0; y < window.y1; ++y) {
                for (int x = window.x0; x < window.x1; ++x) {
                    const std::size_t at = (std::size_t(y) * 44 + std::size_t(x)) * channels;
                    const std::size_t in =
                        (std::size_t(y - window.y0) * std::size_t(window.width()) +
                         std::size_t(x - window.x0)) *
                        channels;
                    for (std::size_t c = 0; c < channels; ++c) {
                        different += std::bit_cast<std::uint32_t>(a.pixels[at + c]) !=
                                     std::bit_cast<std::uint32_t>(b.pixels[in + c]);
                    }
                }
            }
        }
        CHECK(different == 0);
    }
}

}  // namespace

TEST_CASE("equal bits: passes, for any kernel, threads, tiles and crop") {
    const TempFolder folder;
    SceneDesc s = glass_scene(folder);
    s.lights[0].light_group = "key";
    s.film.aovs = {"compositing", "lookdev",   "light_groups", "diffuse@groups",
                   "cryptomatte", "object_id", "variance",     "own = C<RD>+[LOB]"};
    check_schedules(s);
    check_crops(s);
    SceneDesc plain = matte_scene();
    plain.film.aovs = s.film.aovs;
    const auto basic = by_kernel(plain, "basic");
    CHECK(by_kernel(plain, "surface") == basic);
    CHECK(by_kernel(plain, "full") == basic);
}

TEST_CASE("equal bits: every kernel that covers a scene gives the same picture") {
    const TempFolder folder;
    const auto basic = by_kernel(matte_scene(), "basic");
    CHECK(by_kernel(matte_scene(), "surface") == basic);
    CHECK(by_kernel(matte_scene(), "full") == basic);
    CHECK(rendered(matte_scene()) == basic);
    CHECK(build_scene(matte_scene())->statistics().kernel == "basic");
    CHECK(by_kernel(shiny_scene(folder), "surface") == by_kernel(shiny_scene(folder), "full"));
    CHECK_THROWS_AS(by_kernel(shiny_scene(folder), "basic"), Error);
    CHECK_THROWS_AS(by_kernel(glass_scene(folder), "surface"), Error);
}

TEST_CASE("equal bits: threads and tiles change nothing") {
    const TempFolder folder;
    check_schedules(matte_scene());
    check_schedules(glass_scene(folder));
    SceneDesc whitted = glass_scene(folder);
    whitted.render.integrator = Integrator::whitted;
    check_schedules(whitted);
}

TEST_CASE("equal bits: a crop holds the pixels of the full frame") {
    const TempFolder folder;
    check_crops(glass_scene(folder));
    SceneDesc whitted = shiny_scene(folder);
    whitted.render.integrator = Integrator::whitted;
    check_crops(whitted);
}

TEST_CASE("equal bits: beauty does not change when other passes are left out") {
    const TempFolder folder;
    SceneDesc scene = glass_scene(folder);
    const auto all = beauty_of(scene);
    scene.film.aovs = {"beauty"};
    CHECK(beauty_of(scene) == all);
}

TEST_CASE("equal bits: texels drawn at random are drawn by the path, not by its schedule") {
    const TempFolder folder;
    check_schedules(stochastic_scene(folder));
    check_crops(stochastic_scene(folder));
    SceneDesc whitted = stochastic_scene(folder);
    whitted.render.integrator = Integrator::whitted;
    check_schedules(whitted);
    check_crops(whitted);
    // The filter does something: the same texels by their weights are another picture.
    SceneDesc smooth = stochastic_scene(folder);
    smooth.textures[0].filter = TextureFilter::trilinear;
    CHECK(rendered(smooth) != rendered(stochastic_scene(folder)));
}

TEST_CASE("equal bits: with .tx files the memory for textures changes nothing") {
    const TempFolder folder;
    for (SceneDesc scene : {shiny_scene(folder), stochastic_scene(folder)}) {
        // A lamp that shines by its texture is weighed by the texture's mean.
        scene.materials[0].emission_luminance.value = 500;
        scene.materials[0].emission_color.texture = 0;
        BuildOptions tight;
        tight.texture_memory = 1;
        tight.auto_tx = true;
        tight.tx_cache = folder / "tx";
        CHECK(rendered(scene, tight) == rendered(scene));
        CHECK(build_scene(SceneDesc(scene), tight)->statistics().textures_cached == 1);
    }
}
