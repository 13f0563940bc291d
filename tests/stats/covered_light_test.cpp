// Lamps under coat and fuzz: what is seen of them, and what a matte plane gets, which two ways of
// sampling find; against formulas and quadrature of their own.
#include <doctest/doctest.h>

#include <cmath>

#include "materials/lobes/fuzz.h"
#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr double kPiD = 3.14159265358979323846, kCoatIor = 1.6;

// What passes the coat at an angle: Fresnel's rest, and a colour's root for a straight way.
double through_coat(double cosine, double color) {
    const double inside = std::sqrt(1 - (1 - cosine * cosine) / (kCoatIor * kCoatIor));
    const double rs = (cosine - kCoatIor * inside) / (cosine + kCoatIor * inside),
                 rp = (kCoatIor * cosine - inside) / (kCoatIor * cosine + inside);
    return (1 - 0.5 * (rs * rs + rp * rp)) * std::pow(color, 0.5 / inside);
}

MaterialDesc coated_lamp() {
    MaterialDesc m = glowing(1);
    m.coat_weight.value = 1;
    m.coat_color.value = {1, 0.25f, 0.04f};
    return m;
}
constexpr double kColors[] = {1, 0.25, 0.04};

// Radiance of a white matte floor at the origin under the lamp of 2 x 2, or the disc of radius 1,
// at height 1: E / pi, by midpoints.
double expected(bool disc, double color) {
    constexpr int kSteps = 1000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double x = (i + 0.5) / kSteps * 2 - 1, z = (j + 0.5) / kSteps * 2 - 1;
            if (disc && x * x + z * z > 1) continue;
            const double d2 = x * x + z * z + 1;
            sum += through_coat(1 / std::sqrt(d2), color) / (d2 * d2);  // both cosines are 1 / d
        }
    }
    return sum * 4 / (double(kSteps) * kSteps) / kPiD;
}

SceneDesc floor_under_lamp(bool as_disc) {
    SceneDesc scene;
    const int lamp = add(scene, coated_lamp());
    if (as_disc) {
        DiscDesc disc;
        disc.center = {0, 1, 0};
        disc.normal = {0, -1, 0};
        disc.radius = 1;
        disc.material = lamp;
        scene.discs.push_back(disc);
        place(scene, ShapeKind::disc, 0);
    } else {
        add_mesh(scene, quad_mesh({{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, lamp));
    }
    DiscDesc floor;
    floor.radius = 0.01;
    floor.material = add(scene, matte(1));
    scene.discs.push_back(floor);
    place(scene, ShapeKind::disc, scene.discs.size() - 1);
    look_at_point(scene, {0.5, 0.5, 0}, {0, 0, 0});
    return scene;
}

}  // namespace

TEST_CASE("covered light: coat and fuzz tint what is seen of a lamp, more so at an angle") {
    for (const double cosine : {1.0, 0.5, 0.2}) {
        CAPTURE(cosine);
        const auto seen = [&](const MaterialDesc& m) {
            SceneDesc scene;
            DiscDesc disc;
            disc.normal = {std::sqrt(1 - cosine * cosine), 0, cosine};
            disc.material = add(scene, m);
            scene.discs.push_back(disc);
            place(scene, ShapeKind::disc, 0);
            look_at_point(scene, {0, 0, 3}, {0, 0, 0});
            set_film(scene, 4, 4, 1);
            return beauty_of(scene);
        };
        const auto pixels = seen(coated_lamp());
        for (int c = 0; c < 3; ++c)
            CHECK(double(pixels[std::size_t(c)]) ==
                  doctest::Approx(through_coat(cosine, kColors[c])).epsilon(1e-3));
        MaterialDesc half = coated_lamp();
        half.coat_weight.value = 0.5f;
        CHECK(double(seen(half)[1]) ==
              doctest::Approx(0.5 + 0.5 * through_coat(cosine, 0.25)).epsilon(1e-3));
        // Fuzz hides what it reflects.
        MaterialDesc fuzzy = glowing(1);
        fuzzy.fuzz_weight.value = 1;
        const float hidden =
            FuzzLobe::seen_at(static_cast<float>(cosine), fuzzy.fuzz_roughness.value).reflectance;
        CHECK(seen(fuzzy)[0] == doctest::Approx(double(1 - hidden)).epsilon(1e-3));
        CHECK(hidden > 0.0f);
    }
}

TEST_CASE("covered light: a plane under a coated lamp gets its quadrature, by mesh and by disc") {
    for (const bool disc : {false, true}) {
        SceneDesc scene = floor_under_lamp(disc);
        Mean mean[3];
        set_film(scene, 16, 16, 64);
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            scene.render.seed = seed;
            const auto pixels = beauty_of(scene);
            for (std::size_t i = 0; i < pixels.size(); ++i)
                if (i % 4 < 3) mean[i % 4].add(double(pixels[i]));
        }
        for (int c = 0; c < 3; ++c) {
            CAPTURE(disc);
            CAPTURE(c);
            CAPTURE(mean[c].mean());
            const double right = expected(disc, kColors[c]);
            // 4.4 sigma: six tests at 1e-4 in all; 5e-4 for the edge of the disc's quadrature.
            CHECK(std::fabs(mean[c].mean() - right) < 4.4 * mean[c].error() + 5e-4 * right);
            CHECK(mean[c].error() < 3e-3 * right);
        }
    }
}
