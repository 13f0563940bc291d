// Lamps whose light and whose holes are made by graphs: what a matte plane gets of them, against a
// quadrature.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/scene_folder.h"
#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

// A lamp of 2x2 at height 1 over the origin that sends 1 + x, and has a hole where z > 0.3.
double lamp(double x, double z) { return z > 0.3 ? 0 : 1 + x; }

// Radiance of a white matte floor at the origin: E / pi, by midpoints; the hole's edge lies between
// them.
double expected() {
    constexpr int kSteps = 2000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double x = (i + 0.5) / kSteps * 2 - 1, z = (j + 0.5) / kSteps * 2 - 1;
            const double d2 = x * x + z * z + 1;
            sum += lamp(x, z) / (d2 * d2);  // both cosines are 1 / d
        }
    }
    constexpr double kPiD = 3.14159265358979323846;
    return sum * 4 / (double(kSteps) * kSteps) / kPiD;
}

SceneDesc scene_of(const SceneFolder& folder) {
    folder.write("lamp.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n");
    SceneDesc scene = folder.load(
        "[[mesh]]\nname = 'lamp'\nfile = 'lamp.obj'\n"
        // Placed by an instance, so that its own x and z are not the scene's.
        "[[instance]]\nof = 'lamp'\nmaterial = 'lamp'\nrotate_deg = [0, 90, 0]\ntranslate = [0, 1, "
        "0]\n"
        "[material.lamp]\nbase_color = 0\nspecular_weight = 0\n"
        "emission_luminance = { type = 'multiply', in1 = 179, in2 = { type = 'add', in1 = 1, in2 = "
        "{ type = 'extract', in = { node = 'world' }, index = 0 } } }\n"
        "geometry_opacity = { type = 'ifgreater', value1 = { type = 'extract', in = { node = "
        "'world' }, index = 2 }, value2 = 0.3, in1 = 0, in2 = 1 }\n"
        "[material.lamp.node.world]\ntype = 'position'\nspace = 1\n");
    DiscDesc floor;
    floor.radius = 0.01;
    floor.material = add(scene, matte(1));
    scene.discs.push_back(floor);
    place(scene, ShapeKind::disc, 0);
    // From the side, below the lamp.
    look_at_point(scene, {0.5, 0.5, 0}, {0, 0, 0});
    return scene;
}

}  // namespace

TEST_CASE("graph light: a lamp by graphs lights a plane as its quadrature says") {
    const SceneFolder folder;
    SceneDesc scene = scene_of(folder);
    set_film(scene, 16, 16, 64);
    Mean mean;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        scene.render.seed = seed;
        const auto pixels = beauty_of(scene);
        for (std::size_t i = 0; i < pixels.size(); i += 4) mean.add(double(pixels[i]));
    }
    CAPTURE(mean.mean());
    CAPTURE(expected());
    // 4 sigma; 2e-4 for the quadrature's steps at the edge of the hole and the size of the pixels.
    CHECK(std::fabs(mean.mean() - expected()) < 4 * mean.error() + 2e-4 * expected());
    CHECK(mean.error() < 5e-3 * expected());
}

TEST_CASE("graph light: an opacity by the facing ratio lets shadow rays through as it is seen") {
    const SceneFolder folder;
    folder.write("sheet.obj", "v -9 1 -9\nv 9 1 -9\nv 9 1 9\nv -9 1 9\nf 1 2 3 4\n");
    // Light that comes in at 60 degrees meets the sheet with a cosine of one half.
    SceneDesc scene = folder.load(
        "[[mesh]]\nfile = 'sheet.obj'\nmaterial = 'sheet'\n"
        "[[light]]\ntype = 'distant'\ndirection = [0.8660254, -0.5, 0]\nirradiance = 10\n"
        "[material.sheet]\nbase_color = 0\nspecular_weight = 0\n"
        "geometry_opacity = { type = 'facingratio' }\n");
    DiscDesc floor;
    floor.radius = 0.01;
    floor.material = add(scene, matte(1));
    scene.discs.push_back(floor);
    place(scene, ShapeKind::disc, 0);
    look_at_point(scene, {0.5, 0.5, 0}, {0, 0, 0});
    set_film(scene, 16, 16, 64);
    Mean mean;
    const auto pixels = beauty_of(scene);
    for (std::size_t i = 0; i < pixels.size(); i += 4) mean.add(double(pixels[i]));
    const double seen = 10 * 0.5 * 0.5 / 3.14159265358979323846;
    CAPTURE(mean.mean());
    CAPTURE(seen);
    CHECK(std::fabs(mean.mean() - seen) < 4 * mean.error());
}

TEST_CASE("graph light: a map that is missing bends and cuts nothing") {
    const SceneFolder folder;
    SceneDesc plain = folder.load("[[sphere]]\nmaterial = 'm'\n[material.m]\nbase_color = 0.5\n");
    SceneDesc missing = folder.load(
        "[[sphere]]\nmaterial = 'm'\n[material.m]\nbase_color = 0.5\n"
        "geometry_normal = { file = 'gone.png' }\ngeometry_opacity = { file = 'gone.png' }\n"
        "bump = { file = 'gone.png' }\n");
    for (SceneDesc* scene : {&plain, &missing}) {
        look(*scene, {0, 0, 6}, {0, 0, 0});
        set_film(*scene, 16, 16, 16);
    }
    CHECK(beauty_of(plain) == beauty_of(missing));
}
