// Patterns on a ground that runs to the horizon, against the same ground supersampled.

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/picture_statistics.h"
#include "tests/support/scene_folder.h"

using namespace tessera;

namespace {

// A pattern that glows, so that a pixel is the mean of it and of nothing else. `place` is what its
// colours are asked at: of numbers put together again nothing knows the footprint.
struct Ground {
    const char* name;
    const char* color;  // @ stands for the place
    bool flat;          // by texture coordinates, else in space
    double bound;       // of the difference in the upper rows, relative
};
constexpr Ground kGrounds[] = {
    {"checkerboard",
     "{ type = 'checkerboard', color1 = [0.8, 0.5, 0.3], color2 = [0.2, 0.02, 0.01], uvtiling = "
     "[2, 2], texcoord = @ }",
     true, 0.07},
    {"brick", "{ type = 'brick', texcoord = @ }", true, 0.015},
    {"cloth", "{ type = 'cloth', threads = [4, 4], texcoord = @ }", true, 0.02},
    {"wood", "{ type = 'wood', ring_width = 0.2, position = @ }", false, 0.01},
    {"marble", "{ type = 'marble', position = @ }", false, 0.02},
    {"rust",
     "{ type = 'mix', fg = { type = 'rust', position = @ }, bg = [0.4, 0.4, 0.5], mix = { type = "
     "'rust', position = @, output = 'mask' } }",
     false, 0.045},
};

BlockStatistics ground(const Ground& g, bool filtered, int spp, std::uint64_t seed) {
    const SceneFolder folder;
    folder.write("ground.obj",
                 "v -3000 0 -6000\nv -3000 0 10\nv 3000 0 10\nv 3000 0 -6000\nvt -3000 6000\n"
                 "vt -3000 -10\nvt 3000 -10\nvt 3000 6000\nf 1/1 2/2 3/3 4/4\n");
    const std::string own = g.flat ? "texcoord" : "position";
    const auto part = [&](int k) {
        return "{ type = 'extract', in = { type = '" + own + "' }, index = " + std::to_string(k) +
               " }";
    };
    const std::string points = "{ type = 'combine3', in1 = " + part(0) + ", in2 = " + part(1) +
                               ", in3 = " + part(2) + " }";
    std::string color = g.color;
    const std::string place = filtered ? "{ type = '" + own + "' }" : points;
    for (auto at = color.find('@'); at != std::string::npos; at = color.find('@'))
        color.replace(at, 1, place);
    SceneDesc scene = folder.load(
        "[environment]\nradiance = 0\n[[mesh]]\nfile = 'ground.obj'\nmaterial = 'a'\n"
        "[material.a]\nbase_color = 0\nspecular_weight = 0\nemission_luminance = 179\n"
        "emission_color = " +
        color + "\n");
    set_film(scene, 64, 32, spp);
    // The horizon is the picture's upper edge, a little below it.
    look(scene, {0.3, 1.6, 5}, {0.9, 0.9, 2}, 26);
    return block_statistics(scene, seed, 1);
}

// Root of the mean squared difference of blocks from row `first` to row `last`, over the mean.
double difference(const BlockStatistics& a, const BlockStatistics& truth, int first, int last) {
    constexpr int kRow = 16 * 3;
    double square = 0, sum = 0;
    for (int i = first * kRow; i < last * kRow; ++i) {
        const double t = truth.values[static_cast<std::size_t>(i)].mean();
        square += std::pow(a.values[static_cast<std::size_t>(i)].mean() - t, 2);
        sum += t;
    }
    const int n = (last - first) * kRow;
    return std::sqrt(square / n) / (sum / n);
}

}  // namespace

// Row 0 holds the horizon itself, whose edge one sample cannot see. Bounds: 1.2 to 2 times what the
// fixed seeds gave; that of squares is largest, whose box is not turned with the view. Points alone
// err by 2.5 times as much at least: that is the shimmer.
TEST_CASE("patterns: one sample a pixel at the horizon is near the ground supersampled") {
    for (const Ground& g : kGrounds) {
        CAPTURE(g.name);
        const BlockStatistics truth = ground(g, false, 1024, 1), filtered = ground(g, true, 1, 2),
                              points = ground(g, false, 1, 2);
        const double near_it = difference(filtered, truth, 1, 3);
        CHECK(near_it < g.bound);
        CHECK(near_it < 0.45 * difference(points, truth, 1, 3));
        CHECK(difference(filtered, truth, 3, 8) < 0.1);
    }
}
