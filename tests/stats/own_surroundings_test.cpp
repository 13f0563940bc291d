// Light that one kind of ray sees: the environment's images for camera, lighting and reflection,
// and reflection maps. Against closed forms, and against the environment that shows all the same.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/map_files.h"
#include "tests/support/scene_folder.h"
#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr const char* kApart =
    "[environment]\ncamera = 'blue.exr'\nlighting = 'red.exr'\nreflection = 'green.exr'\n";

// Images of one colour each, and a lively one alone in each of three colours.
struct Images {
    SceneFolder folder;
    Images() {
        write_map(folder.path("red.exr"), Color{1, 0, 0});
        write_map(folder.path("green.exr"), Color{0, 1, 0});
        write_map(folder.path("blue.exr"), Color{0, 0, 1});
        for (const auto& [name, channel] : {std::pair{"lively_red.exr", Color{1, 0, 0}},
                                            {"lively_green.exr", {0, 1, 0}},
                                            {"lively.exr", {1, 1, 1}}}) {
            write_map(folder.path(name), MapProjection::latlong, 64, 32,
                      [&, tint = channel](Vec3d d) { return Color(lively(d).y) * tint; });
        }
    }
};

SceneDesc ball(const SceneFolder& folder, const std::string& environment,
               const std::string& material, double fov_deg = 24) {
    SceneDesc scene =
        folder.load(environment + "[[sphere]]\nmaterial = 'm'\n[material.m]\n" + material);
    look(scene, {0, 0, 6}, {0, 0, 0}, fov_deg);
    set_film(scene, 16, 16, 16);
    without_limits(scene);
    return scene;
}

Color pixel(const std::vector<float>& pixels, std::size_t x, std::size_t y) {
    const float* p = &pixels[4 * (16 * y + x)];
    return {p[0], p[1], p[2]};
}

// For single pixels: with 256 samples of light, of two strategies, their spread is below a
// hundredth.
SceneDesc fine(SceneDesc scene) {
    scene.render.spp = 256;
    return scene;
}
bool half_red(Color c) { return std::fabs(c.x - 0.5f) < 0.03f && c.y == 0.0f && c.z == 0.0f; }

// Means over the picture of red, green and blue, from independent seeds.
struct Means {
    Mean channel[3], red_and_green;
};
Means means_of(const SceneDesc& scene, std::uint64_t first_seed) {
    constexpr int kSeeds = 48;
    Means means;
    for (int k = 0; k < kSeeds; ++k) {
        SceneDesc one = scene;
        one.render.seed = first_seed + static_cast<std::uint64_t>(k);
        const std::vector<float> pixels = beauty_of(std::move(one));
        double sum[3] = {};
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            if (i % 4 < 3) sum[i % 4] += double(pixels[i]);
        }
        for (int c = 0; c < 3; ++c) means.channel[c].add(sum[c]);
        means.red_and_green.add(sum[0] + sum[1]);
    }
    return means;
}

double z_of(const Mean& a, const Mean& b) {
    // A part in 1e5 is float rounding.
    const double rounding = 1e-5 * a.mean();
    return (a.mean() - b.mean()) /
           std::sqrt(a.error() * a.error() + b.error() * b.error() + rounding * rounding);
}

// Materials of every kind of lobe.
const std::vector<std::string>& materials() {
    static const std::vector<std::string> all{
        "specular_roughness = 0.3\nbase_color = 0.6\n",
        "specular_roughness = 0\nbase_color = 0.6\n",
        "specular_roughness = 0.5\nbase_metalness = 0.5\nbase_diffuse_roughness = 1\n",
        "coat_weight = 0.7\ncoat_roughness = 0.2\nfuzz_weight = 0.4\nspecular_roughness = 0.5\n",
        "transmission_weight = 0.6\nspecular_roughness = 0.2\nbase_color = 0.5\n",
        "transmission_weight = 1\nspecular_roughness = 0\n",
        "geometry_thin_walled = true\ntransmission_weight = 0.5\nspecular_roughness = 0.3\n"
        "subsurface_weight = 0.5\n",
        "thin_film_weight = 1\nbase_metalness = 1\nspecular_roughness = 0.1\n",
    };
    return all;
}

// Over two tests of every material.
double limit() {
    // The normal quantile of Sidak's level for 1e-4 in all.
    double z = 3;
    while (normal_p(z) > sidak_level(1e-4, 4 * materials().size())) z += 0.01;
    return z;
}

}  // namespace

TEST_CASE("environment images: each kind of ray sees its own") {
    const Images images;
    const auto middle = [&](const std::string& material) {
        return pixel(beauty_of(fine(ball(images.folder, kApart, material))), 8, 8);
    };
    const Color background =
        pixel(beauty_of(ball(images.folder, kApart, "specular_weight = 0\n")), 0, 0);
    CHECK(length(background - Color{0, 0, 1}) < 1e-6f);
    // A convex body of albedo 0.5 in uniform light.
    const Color matte = middle("specular_weight = 0\nbase_color = 0.5\n");
    CHECK(half_red(matte));
    const Color mirror = middle("base_metalness = 1\nbase_color = 1\nspecular_roughness = 0\n");
    CHECK(length(mirror - Color{0, 1, 0}) < 1e-5f);
    // The tables of energy among the microfacets are good to half a percent.
    const Color gloss = middle("base_metalness = 1\nbase_color = 1\nspecular_roughness = 0.5\n");
    CHECK(gloss.y == doctest::Approx(1).epsilon(0.01));
    CHECK(gloss.x + gloss.z == 0.0f);
    const Color glass = middle("transmission_weight = 1\nspecular_roughness = 0\n");
    CHECK(glass.y == doctest::Approx(1).epsilon(0.01));
    CHECK(glass.x + glass.z == 0.0f);
    // A smooth boundary over a matte base: Fresnel's share of the one, the rest of the other.
    const Color plastic = middle("specular_roughness = 0\nbase_color = 0\n");
    CHECK(plastic.y == doctest::Approx(0.04).epsilon(0.02));
    CHECK(plastic.x == 0.0f);
}

TEST_CASE("environment images: those that are not given are the file, or the constant") {
    const Images images;
    const auto seen = [&](const std::string& environment, const std::string& material) {
        const auto pixels = beauty_of(fine(ball(images.folder, environment, material)));
        return std::pair{pixel(pixels, 0, 0), pixel(pixels, 8, 8)};
    };
    const std::string matte = "specular_weight = 0\nbase_color = 0.5\n",
                      mirror = "base_metalness = 1\nbase_color = 1\nspecular_roughness = 0\n";
    const std::string lit = "[environment]\nfile = 'blue.exr'\nlighting = 'red.exr'\n",
                      shown = "[environment]\nradiance = [0, 0, 2]\ncamera = 'blue.exr'\n";
    CHECK(half_red(seen(lit, matte).second));
    CHECK(length(seen(lit, mirror).second - Color{0, 0, 1}) < 1e-5f);
    CHECK(length(seen(lit, mirror).first - Color{0, 0, 1}) < 1e-5f);
    CHECK(length(seen(shown, matte).second - Color{0, 0, 1}) < 1e-5f);
    // The factor is on every image.
    CHECK(length(seen(shown, matte).first - Color{0, 0, 2}) < 1e-5f);
    const std::string hidden = std::string(kApart) + "visible = false\n";
    CHECK(length(seen(hidden, matte).first) == 0.0f);
    CHECK(half_red(seen(hidden, matte).second));
    CHECK(images.folder.failure("[environment]\nreflection = 'none.exr'")
              .find("environment: reflection 'none.exr'") != std::string::npos);
}

TEST_CASE("environment images: the ray tree mirrors the image for reflections") {
    const Images images;
    SceneDesc scene =
        ball(images.folder, kApart, "base_metalness = 1\nbase_color = 1\nspecular_roughness = 0\n");
    scene.render.integrator = Integrator::whitted;
    const auto pixels = beauty_of(std::move(scene));
    CHECK(length(pixel(pixels, 8, 8) - Color{0, 1, 0}) < 1e-5f);
    CHECK(length(pixel(pixels, 0, 0) - Color{0, 0, 1}) < 1e-5f);
}

// Lighting in red and reflection in green: together they are the picture of one environment.
TEST_CASE("environment images: what is lit and what is mirrored adds up to the whole") {
    const Images images;
    std::uint64_t seed = 1;
    for (const std::string& material : materials()) {
        const Means whole = means_of(
            ball(images.folder, "[environment]\nfile = 'lively.exr'\n", material, 16), seed);
        const Means apart =
            means_of(ball(images.folder,
                          "[environment]\nfile = 'lively_green.exr'\nlighting = 'lively_red.exr'\n"
                          "reflection = 'lively_green.exr'\n",
                          material, 16),
                     seed + 500);
        seed += 1000;
        CAPTURE(material);
        CAPTURE(apart.channel[0].mean());
        CAPTURE(apart.channel[1].mean());
        CHECK(whole.channel[1].error() < 0.01 * whole.channel[1].mean());
        CHECK(std::fabs(z_of(whole.channel[1], apart.red_and_green)) < limit());
    }
}

TEST_CASE("environment images: lighting that holds nothing of the reflection keeps it unbiased") {
    const Images images;
    // Light sampling goes to the wrong places, or to none at all: only noise may grow.
    write_map(images.folder.path("elsewhere.exr"), MapProjection::latlong, 64, 32, [](Vec3d d) {
        return Color{lively(-d).y, 0, 0};
    });
    write_map(images.folder.path("black.exr"), Color(0.0f));
    std::uint64_t seed = 90000;
    for (const std::string roughness : {"0.2", "0.5"}) {
        const std::string material = "base_metalness = 1\nspecular_roughness = " + roughness + "\n";
        const Means whole = means_of(
            ball(images.folder, "[environment]\nfile = 'lively.exr'\n", material, 16), seed);
        for (const std::string lighting : {"elsewhere.exr", "black.exr"}) {
            const Means apart =
                means_of(ball(images.folder,
                              std::string("[environment]\nfile = 'lively.exr'\nlighting = '") +
                                  lighting + "'\n",
                              material, 16),
                         seed + 500);
            CAPTURE(roughness);
            CAPTURE(lighting);
            CHECK(std::fabs(z_of(whole.channel[1], apart.channel[1])) < limit());
        }
        seed += 1000;
    }
}

TEST_CASE("reflection map: the environment itself as the map changes nothing") {
    const Images images;
    std::uint64_t seed = 50000;
    for (const std::string& material : materials()) {
        const std::string sky = "[environment]\nfile = 'lively.exr'\nrotate_deg = 30\n";
        const Means whole = means_of(ball(images.folder, sky, material, 16), seed);
        const Means mapped = means_of(
            ball(images.folder, sky,
                 material + "reflection_map = { file = 'lively.exr', rotate_deg = 30 }\n", 16),
            seed + 500);
        seed += 1000;
        CAPTURE(material);
        CHECK(std::fabs(z_of(whole.channel[1], mapped.channel[1])) < limit());
    }
}

TEST_CASE("own surroundings: the picture has the same bits for any number of threads and tile") {
    const Images images;
    const SceneDesc scene =
        ball(images.folder,
             "[environment]\nfile = 'lively.exr'\nreflection = 'lively_green.exr'\n[[disc]]\n"
             "center = [0, -1, 0]\nradius = 5\n",
             "transmission_weight = 0.5\nspecular_roughness = 0.2\nreflection_map = { file = "
             "'lively.exr', "
             "position = [0, 0, 0], radius = 4 }\n",
             40);
    RenderSettings one, other;
    one.threads = 1, one.tile = 32;
    other.threads = 2, other.tile = 4;
    CHECK(beauty_of(scene, {}, one) == beauty_of(scene, {}, other));
}
