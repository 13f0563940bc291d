#include "renderer/error/tile_error.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <vector>

#include "renderer/core/parallel.h"
#include "renderer/error/calibration.h"
#include "renderer/error/estimate.h"
#include "renderer/error/interval.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

// Without probes, unless add_probes() is called.
struct Picture {
    PixelWindow window;
    std::vector<Sum> sums, probe_sums;
    std::vector<PixelCounts> counts;
    std::vector<std::uint32_t> probe_counts;
    ProbeGrid grid;

    Picture(int w, int h) : Picture(PixelWindow{0, 0, w, h}) {}
    explicit Picture(const PixelWindow& w)
        : window(w),
          sums(std::size_t(w.width()) * w.height() * kReplicates * 3),
          counts(std::size_t(w.width()) * w.height()) {}
    ReplicateView view() const { return {window, sums, counts, {grid, probe_sums, probe_counts}}; }
    // value(pixel): of the second rendering.
    template <class Value>
    void add_probes(Value value) {
        grid = ProbeGrid(window, 3);
        probe_sums.resize(3 * grid.cells());
        probe_counts.resize(grid.cells());
        grid.each_inside(window, [&](std::size_t cell, ProbeGrid::Pixel p) {
            const std::size_t pixel = view().pixel(p.x, p.y);
            probe_counts[cell] = counts[pixel].total();
            for (std::size_t c = 0; c < 3; ++c)
                probe_sums[3 * cell + c].add(value(pixel) * probe_counts[cell]);
        });
    }
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
    return tile_error(p.view(), p.window, epsilon);
}

Calibration calibration_of(const Picture& p, double epsilon = 1) {
    return calibrate(p.view(), error_of(p, epsilon), epsilon);
}

// A picture of noise about 1, by one of the random generator's seeds.
Picture noise(const PixelWindow& window, std::uint64_t seed) {
    Picture p(window);
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
    const Picture p = noise({0, 0, 37, 3}, 5);
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
    const Picture p = noise({-3, 5, 97, 75}, 3);
    Workers one(1), two(2);
    const ErrorEstimate a = estimate_error(p.view(), one), b = estimate_error(p.view(), two);
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
    Picture p = noise({0, 0, 96, 96}, 8);
    for (int y = 40; y < 60; ++y) {
        for (int x = 70; x < 90; ++x) {
            Random random(static_cast<std::uint64_t>(x * 100 + y));
            for (int r = 0; r < kReplicates; ++r)
                p.add(static_cast<std::size_t>(y * 96 + x), r,
                      Vec3d(8 * static_cast<double>(random.unit())), 2);
        }
    }
    Workers workers(2);
    const ErrorEstimate e = estimate_error(p.view(), workers);
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
    const ErrorEstimate b = estimate_error(black.view(), workers);
    CHECK(b.known);
    CHECK(b.rmse.high == 0);
    CHECK(b.relmse.high == 0);
    CHECK(b.relmse.reliable);
    const ErrorEstimate l = estimate_error(lamp.view(), workers);
    CHECK_FALSE(l.rmse.reliable);
    CHECK(l.largest_share == doctest::Approx(1));
    CHECK_FALSE(l.cautions.empty());
}

TEST_CASE("calibration: probes say by how much the replicates' errors are off") {
    // The second rendering's noise is half of what the replicates tell: a quarter of the error, and
    // of the first there is as much as they tell.
    Picture p = noise({5, 9, 325, 249}, 4);
    Random random(77);
    p.add_probes([&](std::size_t) {
        const double replicate = static_cast<double>(random.unit()) - 0.5;
        return 1.0 + 0.25 * replicate;  // a replicate's deviation, halved by four, halved again
    });
    const Calibration c = calibration_of(p, 1e-4);
    CHECK(c.probes > 2300);
    // (1 + 1/4) / 2: within four standard deviations.
    CHECK(std::abs(std::log(c.squared.value / 0.625)) < 4 * std::sqrt(c.squared.spread));
    CHECK(c.squared.spread < 0.04 * 0.04);  // sqrt((2 + 2/3) / 2400) = 0.033
    CHECK(c.relative.value == doctest::Approx(c.squared.value).epsilon(0.02));
    Picture bare = noise({5, 9, 325, 249}, 4);
    Workers workers(1);
    const double with = estimate_error(p.view(), workers).rmse.value,
                 without = estimate_error(bare.view(), workers).rmse.value;
    const double usual = calibration_of(bare, 1e-4).squared.value;
    CHECK(with / without == doctest::Approx(std::sqrt(c.squared.value / usual)));
}

TEST_CASE("calibration: without probes, or with too few of them, the usual factor with its doubt") {
    const Calibration none = calibration_of(noise({0, 0, 64, 64}, 4));
    CHECK(none.probes == 0);
    CHECK(none.squared.value == doctest::Approx(1).epsilon(0.1));  // independent runs
    CHECK(none.squared.spread > 0.2 * 0.2);
    Picture one = noise({0, 0, 8, 4}, 4);
    one.add_probes([](std::size_t) { return 100.0; });
    const Calibration c = calibration_of(one);
    CHECK(c.probes == 1);
    CHECK(c.squared.value < 1.2);  // one may be anything
}

TEST_CASE("calibration: a probe that is not as far as its pixel does not count") {
    Picture p = noise({0, 0, 64, 64}, 4);
    p.add_probes([](std::size_t) { return 1.0; });
    CHECK(calibration_of(p).probes == 128);
    --p.probe_counts[7];
    CHECK(calibration_of(p).probes == 127);
}

TEST_CASE(
    "probe grid: every 8x4 has one, wherever the window lies, and a crop has those of the whole") {
    const PixelWindow whole{-20, -9, 83, 61}, crop{-3, 2, 50, 41};
    const ProbeGrid all(whole, 5), part(crop, 5);
    std::vector<std::pair<int, int>> in_crop, of_part;
    std::size_t inside = 0;
    all.each_inside(whole, [&](std::size_t cell, ProbeGrid::Pixel p) {
        ++inside;
        CHECK(all.cell_of(p) == cell);
        if (p.x >= crop.x0 && p.x < crop.x1 && p.y >= crop.y0 && p.y < crop.y1)
            in_crop.emplace_back(p.x, p.y);
    });
    part.each_inside(crop,
                     [&](std::size_t, ProbeGrid::Pixel p) { of_part.emplace_back(p.x, p.y); });
    CHECK(in_crop == of_part);
    CHECK(inside > 103 * 70 / 32 - 40);
    CHECK(inside <= all.cells());
    // Another seed has others.
    const ProbeGrid other(whole, 6);
    int same = 0;
    for (std::size_t cell = 0; cell < all.cells(); ++cell)
        same +=
            all.probe(cell).x == other.probe(cell).x && all.probe(cell).y == other.probe(cell).y;
    CHECK(same < 25);  // a 32nd of 266: 8.3 +- 2.8
}

TEST_CASE("replicates: the first 2^k samples of a pixel are four runs of as many points") {
    for (const std::uint32_t n : {4u, 8u, 16u, 32u, 64u, 1024u}) {
        std::vector<std::uint32_t> of(n);
        std::uint32_t log_run = 0;
        for (std::uint32_t s = 0; s < n; ++s)
            log_run = std::max(log_run, run_of(point_of_sample(s)));
        CHECK(n == 4u << log_run);
        std::uint32_t counts[kReplicates]{};
        for (std::uint32_t s = 0; s < n; ++s) {
            REQUIRE(point_of_sample(s) < n);
            CHECK(of[point_of_sample(s)]++ == 0);  // a permutation
            ++counts[point_of_sample(s) >> log_run];
        }
        for (const std::uint32_t c : counts) CHECK(c == n / 4);
    }
}

TEST_CASE("replicates: between powers of two the runs that are new grow together") {
    for (std::uint32_t n = 64; n < 128; ++n) {
        std::uint32_t counts[kReplicates]{};
        for (std::uint32_t s = 0; s <= n; ++s) ++counts[point_of_sample(s) >> 5];
        CHECK(counts[0] == 32);
        CHECK(counts[1] == 32);
        CHECK(counts[2] - counts[3] <= 1);
    }
}

TEST_CASE("interval: n independent ones hold together by a wider quantile") {
    CHECK(joint_quantile(1) == doctest::Approx(kQuantile));
    CHECK(joint_quantile(2) == doctest::Approx(2.2365));  // erf(q / sqrt(2)) = sqrt(0.95)
    CHECK(joint_quantile(1000) > 4);
}
