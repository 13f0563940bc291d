// Pictures of known truth, made of noise whose distribution is known: how often the interval holds
// the picture's error.

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "renderer/core/parallel.h"
#include "renderer/error/estimate.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

constexpr int kSide = 48, kPictures = 400;

struct Coverage {
    int rmse = 0, relmse = 0, rmse_reliable = 0, relmse_reliable = 0;
    int false_assurance = 0;  // called reliable, and the truth is above 1.5 of the estimate
    double rmse_ratio = 0, relmse_ratio = 0;  // estimated over true, means
};

double normal(Random& random) {
    const double u = 1.0 - static_cast<double>(random.unit()),
                 v = static_cast<double>(random.unit());
    return std::sqrt(-2.0 * std::log(u)) * std::cos(6.283185307179586 * v);
}

// truth(pixel); noise(pixel, random): a replicate's value over the truth, of mean 1.
template <class Truth, class Noise>
Coverage measure(Truth truth, Noise noise) {
    Coverage c;
    Workers workers(1);
    double mean = 0;
    for (int i = 0; i < kSide * kSide; ++i) mean += truth(i) / (kSide * kSide);
    const double epsilon = 0.01 * mean * mean;
    for (int k = 0; k < kPictures; ++k) {
        Random random(static_cast<std::uint64_t>(1000 + k));
        std::vector<Sum> sums(std::size_t(kSide) * kSide * kReplicates * 3);
        std::vector<PixelCounts> counts(std::size_t(kSide) * kSide);
        double squared = 0, relative = 0;
        for (int i = 0; i < kSide * kSide; ++i) {
            double pixel = 0;
            for (int r = 0; r < kReplicates; ++r) {
                const double v = truth(i) * noise(i, random);
                pixel += v / kReplicates;
                counts[static_cast<std::size_t>(i)].samples[r] = 1;
                for (int ch = 0; ch < 3; ++ch)
                    sums[static_cast<std::size_t>((i * kReplicates + r) * 3 + ch)].add(v);
            }
            const double d = pixel - truth(i);
            squared += d * d / (kSide * kSide);
            relative += d * d / (truth(i) * truth(i) + epsilon) / (kSide * kSide);
        }
        // Independent replicates: a second rendering is of one mould with the first.
        const ProbeGrid grid({0, 0, kSide, kSide}, static_cast<std::uint64_t>(k));
        std::vector<Sum> probe_sums(3 * grid.cells());
        const std::vector<std::uint32_t> probe_counts(grid.cells(), kReplicates);
        grid.each_inside({0, 0, kSide, kSide}, [&](std::size_t cell, ProbeGrid::Pixel p) {
            const int i = p.y * kSide + p.x;
            for (int r = 0; r < kReplicates; ++r) {
                const double v = truth(i) * noise(i, random);
                for (std::size_t ch = 0; ch < 3; ++ch) probe_sums[3 * cell + ch].add(v);
            }
        });
        const ErrorEstimate e = estimate_error(
            {{0, 0, kSide, kSide}, sums, counts, {grid, probe_sums, probe_counts}}, workers);
        const double rmse = std::sqrt(squared);
        c.rmse += rmse >= e.rmse.low && rmse <= e.rmse.high;
        c.relmse += relative >= e.relmse.low && relative <= e.relmse.high;
        c.rmse_reliable += e.rmse.reliable;
        c.false_assurance += (e.rmse.reliable && rmse > 1.5 * e.rmse.value) ||
                             (e.relmse.reliable && relative > 1.5 * e.relmse.value);
        c.relmse_reliable += e.relmse.reliable;
        c.rmse_ratio += e.rmse.value / rmse / kPictures;
        c.relmse_ratio += e.relmse.value / relative / kPictures;
    }
    return c;
}

// Of 400 intervals that hold with 0.95: 380 +- 4.4; three of those are 367. They may hold more
// often: the doubt about the calibration is one between scenes, and 72 probes do not take all of
// it.
constexpr int kLeast = 367;
// Nor all of the usual factor, 0.92 of squared errors, where the right one is 1.
constexpr double kTowardUsual = 0.04;

}  // namespace

TEST_CASE("error coverage: normal noise on a ramp") {
    const Coverage c = measure([](int i) { return 0.1 + i % kSide * 0.05; },
                               [](int, Random& r) { return 1 + 0.1 * normal(r); });
    CHECK(c.rmse >= kLeast);
    CHECK(c.relmse >= kLeast);
    CHECK(c.rmse_reliable == kPictures);
    CHECK(c.relmse_reliable == kPictures);
    CHECK(c.rmse_ratio <= 1.005);
    CHECK(c.rmse_ratio >= 1 - kTowardUsual);
    CHECK(c.relmse_ratio == doctest::Approx(1).epsilon(2 * kTowardUsual));
}

TEST_CASE("error coverage: skewed noise, as light makes it") {
    // Log-normal with a deviation of half of the mean: four replicates, so the picture has a
    // quarter.
    const double s2 = std::log(1.25), s = std::sqrt(s2);
    const Coverage c = measure([](int i) { return i / kSide % 8 < 4 ? 0.2 : 1.0; },
                               [&](int, Random& r) { return std::exp(s * normal(r) - 0.5 * s2); });
    CHECK(c.rmse >= kLeast);
    CHECK(c.relmse >= kLeast);
    CHECK(c.rmse_reliable >= 0.95 * kPictures);
    CHECK(c.relmse_reliable >= 0.95 * kPictures);
    CHECK(c.rmse_ratio == doctest::Approx(1).epsilon(kTowardUsual));
    CHECK(c.relmse_ratio == doctest::Approx(1).epsilon(2 * kTowardUsual));
}

TEST_CASE("error coverage: rare events do not give false assurance") {
    // One replicate in a thousand finds what makes a fifth of the light.
    const Coverage c = measure([](int) { return 1.0; },
                               [](int, Random& r) {
                                   const double base = 0.8 * (1 + 0.02 * normal(r));
                                   return base + (r.unit() < 1e-3f ? 200.0 : 0.0);
                               });
    CHECK(c.false_assurance < 0.05 * kPictures);
}
