// A sky with a sun of one texel, 1e5 times as bright as the rest: what matte surfaces get of it,
// against a quadrature of the map that shares no code with the renderer.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/support/map_files.h"
#include "tests/support/scene_folder.h"
#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kW = 64, kH = 32, kSunX = 41, kSunY = 9;

double texel(int x, int y) {
    if (x == kSunX && y == kSunY) return 1e5;
    return 0.6 + 0.3 * std::sin(2 * kPiD * x / kW) + 0.2 * y / kH;
}

// Between the middles of texels, around the back, not over the poles.
double looked_up(double u, double v) {
    const double x = u * kW - 0.5, y = v * kH - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const double tx = x - x0, ty = y - y0;
    const auto at = [&](int i, int j) { return texel((i + kW) % kW, std::clamp(j, 0, kH - 1)); };
    return (at(x0, y0) * (1 - tx) + at(x0 + 1, y0) * tx) * (1 - ty) +
           (at(x0, y0 + 1) * (1 - tx) + at(x0 + 1, y0 + 1) * tx) * ty;
}

// Midpoints of the squares between the texels' middles and edges, in which the map is smooth; 32 to
// a side make the error of a bilinear piece times a cosine less than 1e-5.
double irradiance(Vec3d n) {
    constexpr int kSteps = 32;
    double sum = 0;
    for (int j = 0; j < kH * kSteps; ++j) {
        const double v = (j + 0.5) / (kH * kSteps), theta = kPiD * v;
        double row = 0;
        for (int i = 0; i < kW * kSteps; ++i) {
            const double u = (i + 0.5) / (kW * kSteps), phi = 2 * kPiD * (u - 0.5);
            const Vec3d d{std::sin(theta) * std::sin(phi), std::cos(theta),
                          -std::sin(theta) * std::cos(phi)};
            const double cosine = dot(d, n);
            if (cosine > 0) row += cosine * looked_up(u, v);
        }
        sum += row * std::sin(theta);
    }
    return sum * 2 * kPiD * kPiD / (double(kW) * kH * kSteps * kSteps);
}

SceneDesc lit_scene(const SceneFolder& folder) {
    LayeredImage image;
    image.width = kW, image.height = kH;
    image.window = {0, 0, kW, kH};
    Layer layer{"", {"R", "G", "B"}, LayerKind::data, {}};
    for (int i = 0; i < kW * kH; ++i)
        layer.pixels.insert(layer.pixels.end(), 3, static_cast<float>(texel(i % kW, i / kW)));
    image.layers.push_back(std::move(layer));
    write_exr(image, folder.path("sun.exr"), {.all_float = true});
    return folder.load("[environment]\nfile = 'sun.exr'\n");
}

// Pixels of a parallel view so small that all show the same point.
struct Shown {
    Mean mean;
    double most = 0;
};
Shown shown(SceneDesc scene, Vec3d n, std::uint64_t seeds, int spp) {
    const Vec3d eye = n * 3.0;
    look_at_point(scene, {eye.x, eye.y, eye.z}, {0, 0, 0});
    if (std::fabs(n.y) > 0.9) scene.camera.up = {0, 0, -1};
    set_film(scene, 16, 16, spp);
    Shown out;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        scene.render.seed = seed;
        const auto pixels = beauty_of(scene);
        for (std::size_t i = 0; i < pixels.size(); i += 4) {
            out.mean.add(double(pixels[i]));
            out.most = std::max(out.most, double(pixels[i]));
        }
    }
    return out;
}

const std::vector<Vec3d>& normals() {
    static const std::vector<Vec3d> all{{0, 1, 0},
                                        normalize(Vec3d{0.8, 0.3, 0.2}),
                                        normalize(Vec3d{-0.3, 0.2, -1}),
                                        normalize(Vec3d{0.2, -0.9, 0.4}),
                                        {0, -1, 0}};
    return all;
}

}  // namespace

TEST_CASE("sun texel: a plane and a sphere get the quadrature of the map") {
    const SceneFolder folder;
    const SceneDesc sky = lit_scene(folder);
    for (const Vec3d n : normals()) {
        // What a surface of albedo 1 sends back.
        const double expected = irradiance(n) / kPiD;
        SceneDesc plane = sky, ball = sky;
        DiscDesc disc;
        disc.normal = {n.x, n.y, n.z};
        disc.material = add(plane, matte(1));
        plane.discs.push_back(disc);
        place(plane, ShapeKind::disc, 0);
        const Vec3d center = n * -2.0;
        add_sphere(ball, {center.x, center.y, center.z}, 2, add(ball, matte(1)));
        for (const auto& [what, scene] : {std::pair{"plane", &plane}, {"sphere", &ball}}) {
            const Shown s = shown(*scene, n, 12, 64);
            const std::string which = what;
            CAPTURE(which);
            CAPTURE(fmt::format("{} {} {}", n.x, n.y, n.z));
            CAPTURE(s.mean.mean());
            CAPTURE(expected);
            // 4.4 sigma: ten tests at 1e-4 in all; 1e-4 for the quadrature and for float.
            CHECK(std::fabs(s.mean.mean() - expected) < 4.4 * s.mean.error() + 1e-4 * expected);
            CHECK(s.mean.error() < 2e-3 * expected);
        }
    }
}

TEST_CASE("sun texel: no single path is an outlier") {
    const SceneFolder folder;
    const SceneDesc sky = lit_scene(folder);
    for (const Vec3d n : normals()) {
        SceneDesc ball = sky;
        const Vec3d center = n * -2.0;
        add_sphere(ball, {center.x, center.y, center.z}, 2, add(ball, matte(1)));
        const Shown s = shown(std::move(ball), n, 64, 1);  // 16384 paths
        CAPTURE(fmt::format("{} {} {}", n.x, n.y, n.z));
        CAPTURE(s.mean.mean());
        CAPTURE(s.most);
        // The table is flat within a texel. The one diagonal to the sun has 1/64 of the sun's
        // radiance on average and 1/4 in its corner: 16 times the mean, and a little for the
        // cosine.
        CHECK(s.most < 18 * s.mean.mean());
        CHECK(s.mean.variance() < 2 * s.mean.mean() * s.mean.mean());
    }
}
