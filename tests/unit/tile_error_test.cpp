#include "renderer/error/tile_error.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "renderer/core/parallel.h"
#include "renderer/error/estimate.h"
#include "renderer/error/interval.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

struct Picture {
    int width = 0, height = 0;
    std::vector<Sum> sums;
    std::vector<PixelCounts> counts;

    Picture(int w, int h)
        : width(w),
          height(h),
          sums(std::size_t(w) * h * kReplicates * 3),
          counts(std::size_t(w) * h) {}
    ReplicateView view() const { return {width, height, sums, counts}; }
    void add(std::size_t pixel, int replicate, Vec3d rgb, std::uint32_t samples = 1) {
        for (int c = 0; c < 3; ++c)
            sums[(pixel * kReplicates + replicate) * 3 + c].add(rgb[c] * samples);
        counts[pixel].samples[replicate] += samples;
    }
};

Picture one_pixel(std::array<double, kReplicates> red,
                  std::array<std::uint32_t, kReplicates> samples) {
    Picture p(1, 1);
    for (int r = 0; r < kReplicates; ++r) p.add(0, r, {red[r], 2 * red[r], 0}, samples[r]);
    return p;
}

TileError error_of(const Picture& p, double epsilon = 1) {
    return tile_error(p.view(), {0, 0, p.width, p.height}, epsilon);
}

// A picture of noise about 1, by one of the random generator's seeds.
Picture noise(int width, int height, std::uint64_t seed) {
    Picture p(width, height);
    Random random(seed);
    for (std::size_t i = 0; i < p.counts.size(); ++i)
        for (int r = 0; r < kReplicates; ++r)
            p.add(i, r, Vec3d(0.5 + static_cast<double>(random.unit())), 2);
    return p;
}

}  // namespace

TEST_CASE("tile error: four equal replicates give the variance of their mean") {
    const TileError e = error_of(one_pixel({1, 2, 3, 4}, {8, 8, 8, 8}));
    CHECK(e.known);
    // Red: s^2 = 5/3, over four; green four times that, blue none; the mean of the three.
    CHECK(e.absolute.error == doctest::Approx(5 * 5.0 / 12 / 3));
}

TEST_CASE("tile error: the spread is that of products of differences, by hand") {
    const TileError e = error_of(one_pixel({1, 2, 3, 5}, {1, 1, 1, 1}));
    // Products by match: 2, 6, 4 of red; green's are four times those; sum of squares 25 * 56; a
    // twelfth is sigma^4, a sixth of that the variance of the error; over three channels squared.
    // And what is left where products vanish: 0.005 of the squared error, 35 / 12 / 4 of red.
    const double error = 35.0 / 48 * 5 / 3;
    CHECK(e.absolute.spread == doctest::Approx(25 * 56.0 / 12 / 6 / 9 + 0.005 * error * error));
}

TEST_CASE("tile error: replicates count by their samples") {
    const TileError e = error_of(one_pixel({1, 2, 2, 2}, {3, 1, 1, 1}));
    // Mean 1.5; a sample's variance (3/4 + 3/4) / 3, over six samples; five times red's, over three
    // channels.
    CHECK(e.absolute.error == doctest::Approx(0.5 / 6 * 5 / 3));
}

TEST_CASE(
    "tile error: relative errors lie between the one that is too low and the one that is too "
    "high") {
    const TileError e = error_of(one_pixel({1, 0, 0, 0}, {1, 1, 1, 1}), 0.01);
    CHECK(e.low.error < relative_error(e).error);
    CHECK(relative_error(e).error < e.high.error);
    // Red, from the mean 1/4 and its variance 1/16: 1/16 / (1/16 + 0.01); green, twice that, with
    // 1/4 / (1/4 + 0.01).
    CHECK(e.low.error == doctest::Approx((0.0625 / 0.0725 + 0.25 / 0.26) / 3));
    // Half of the six ways to take two apart see the outlier's difference: 1/8 / 0.01 for red, 1/2
    // / 0.01 for green.
    CHECK(e.high.error == doctest::Approx((12.5 + 50.0) / 2 / 3));
}

TEST_CASE("tile error: equal replicates are without error, and a missing one is noticed") {
    const TileError e = error_of(one_pixel({0.1, 0.1, 0.1, 0.1}, {3, 3, 3, 2}));
    CHECK(e.absolute.error < 1e-15);
    CHECK(e.high.error < 1e-14);
    CHECK(e.known);
    CHECK_FALSE(error_of(one_pixel({1, 1, 1, 0}, {1, 1, 1, 0})).known);
}

TEST_CASE("tile error: a tile of any width is the sum of its pixels") {
    const Picture p = noise(37, 3, 5);
    TileError whole = error_of(p), sum;
    for (int y = 0; y < 3; ++y) {
        for (int x = 0; x < 37; ++x) {
            const TileError one = tile_error(p.view(), {x, y, x + 1, y + 1}, 1);
            sum.absolute.add(one.absolute);
            sum.low.add(one.low);
            sum.high.add(one.high);
        }
    }
    CHECK(whole.absolute.error == doctest::Approx(sum.absolute.error));
    CHECK(whole.absolute.spread == doctest::Approx(sum.absolute.spread));
    CHECK(whole.low.error == doctest::Approx(sum.low.error));
    CHECK(whole.high.error == doctest::Approx(sum.high.error));
    CHECK(whole.high.spread == doctest::Approx(sum.high.spread));
}

TEST_CASE("error estimate: the same bits for any number of threads") {
    const Picture p = noise(100, 70, 3);
    Workers one(1), two(2);
    const ErrorEstimate a = estimate_error(p.view(), {-3, 5, 97, 75}, one),
                        b = estimate_error(p.view(), {-3, 5, 97, 75}, two);
    CHECK(a.rmse.value == b.rmse.value);
    CHECK(a.rmse.high == b.rmse.high);
    CHECK(a.relmse.value == b.relmse.value);
    CHECK(a.relmse.low == b.relmse.low);
    CHECK(a.worst_tile.high == b.worst_tile.high);
    // A tile begins where the frame's do.
    CHECK(a.tile.x1 % 32 * (a.tile.x1 - 97) == 0);
    CHECK(a.tile.y1 % 32 * (a.tile.y1 - 75) == 0);
}

TEST_CASE("error estimate: the worst tile is where the noise is") {
    Picture p = noise(96, 96, 8);
    for (int y = 40; y < 60; ++y) {
        for (int x = 70; x < 90; ++x) {
            Random random(static_cast<std::uint64_t>(x * 100 + y));
            for (int r = 0; r < kReplicates; ++r)
                p.add(static_cast<std::size_t>(y * 96 + x), r,
                      Vec3d(8 * static_cast<double>(random.unit())), 2);
        }
    }
    Workers workers(2);
    const ErrorEstimate e = estimate_error(p.view(), {0, 0, 96, 96}, workers);
    CHECK(e.tile.x0 == 64);
    CHECK(e.tile.y0 == 32);
    CHECK(e.worst_tile.value > 2 * e.rmse.value);
    CHECK(e.worst_tile.low < e.worst_tile.value);
    CHECK(e.worst_tile.high > e.worst_tile.value);
}

TEST_CASE(
    "error estimate: a black picture is right, one pixel that is all the noise is nothing to rely "
    "on") {
    Workers workers(1);
    Picture black(8, 8), lamp(8, 8);
    for (std::size_t i = 0; i < 64; ++i)
        for (int r = 0; r < kReplicates; ++r)
            black.add(i, r, {}), lamp.add(i, r, Vec3d(i == 9 ? 100.0 * r : 1.0));
    const ErrorEstimate b = estimate_error(black.view(), {0, 0, 8, 8}, workers);
    CHECK(b.known);
    CHECK(b.rmse.high == 0);
    CHECK(b.relmse.high == 0);
    CHECK(b.relmse.reliable);
    const ErrorEstimate l = estimate_error(lamp.view(), {0, 0, 8, 8}, workers);
    CHECK_FALSE(l.rmse.reliable);
    CHECK(l.largest_share == doctest::Approx(1));
    CHECK_FALSE(l.cautions.empty());
}

TEST_CASE("interval: n independent ones hold together by a wider quantile") {
    CHECK(joint_quantile(1) == doctest::Approx(kQuantile));
    CHECK(joint_quantile(2) == doctest::Approx(2.2365));  // erf(q / sqrt(2)) = sqrt(0.95)
    CHECK(joint_quantile(1000) > 4);
}
