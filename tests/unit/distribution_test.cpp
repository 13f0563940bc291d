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
