#include "renderer/core/distribution.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

using namespace tessera;

TEST_CASE("distribution 2d: the search finds the cell that the cumulative says") {
    std::mt19937 rng(5);
    std::uniform_real_distribution<float> u(0, 1);
    constexpr int kWidth = 37, kHeight = 11;
    std::vector<double> weights(kWidth * kHeight);
    for (double& w : weights)
        w = u(rng) < 0.4f ? 0.0 : std::pow(10.0, 6.0 * static_cast<double>(u(rng)) - 3.0);
    const Distribution2D table(kWidth, kHeight, weights);
    for (int i = 0; i < 20000; ++i) {
        const Vec2f at = i == 0 ? Vec2f{0, 0} : Vec2f{u(rng), u(rng)};
        const Distribution2D::Sample s = table.sample(at);
        const int x = static_cast<int>(s.uv.x * kWidth), y = static_cast<int>(s.uv.y * kHeight);
        REQUIRE(x < kWidth);
        REQUIRE(y < kHeight);
        // A cell of no weight is never found, and the density is the one that pdf() gives there.
        CHECK(weights[std::size_t(y) * kWidth + x] > 0);
        CHECK(std::fabs(s.pdf - table.pdf(s.uv)) <= 1e-3f * s.pdf);
    }
}

TEST_CASE(
    "alias table: a million cells are hit as often as they weigh, and the remainder is even") {
    // With 24 bits alone each cell would see 16 numbers, and the remainder a few of them.
    constexpr std::size_t kCells = 1000000;
    constexpr int kTries = 4000000;
    std::vector<double> weights(kCells);
    for (std::size_t i = 0; i < kCells; ++i) weights[i] = 1.0 + 0.37 * static_cast<double>(i % 7);
    const AliasTable table(weights);
    double total = 0;
    for (double w : weights) total += w;
    std::mt19937 rng(3);
    const auto unit = [&] { return static_cast<float>(rng() >> 8) * 0x1p-24f; };
    double hits[7] = {}, remainders[64] = {};
    for (int i = 0; i < kTries; ++i) {
        const AliasTable::Pick pick = table.sample(unit(), static_cast<std::uint32_t>(rng()));
        ++hits[pick.index % 7];
        ++remainders[static_cast<int>(pick.remainder * 64)];
    }
    double chi = 0;
    for (int k = 0; k < 7; ++k) {
        double expected = 0;
        for (std::size_t i = static_cast<std::size_t>(k); i < kCells; i += 7)
            expected += weights[i];
        expected *= kTries / total;
        chi += (hits[k] - expected) * (hits[k] - expected) / expected;
    }
    CHECK(chi < 22.5);  // 6 degrees of freedom, p = 0.001
    double chi_remainder = 0;
    for (double h : remainders)
        chi_remainder += (h - kTries / 64.0) * (h - kTries / 64.0) / (kTries / 64.0);
    CHECK(chi_remainder < 103.4);  // 63 degrees of freedom, p = 0.001
}
