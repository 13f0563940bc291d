#include "renderer/compare/heat_map.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace tessera;

TEST_CASE("heat map: it begins black, ends white, and grows brighter all the way") {
    CHECK(cubehelix(0) == std::array<float, 3>{0, 0, 0});
    CHECK(cubehelix(1) == std::array<float, 3>{1, 1, 1});
    float before = -1;
    for (int i = 0; i <= 100; ++i) {
        const auto c = cubehelix(static_cast<float>(i) / 100);
        // the weights that Green 2011 keeps linear
        const float light = 0.30f * c[0] + 0.59f * c[1] + 0.11f * c[2];
        CHECK(light > before);
        CHECK(light == doctest::Approx(i / 100.0).epsilon(0.02));
        before = light;
    }
}

TEST_CASE("heat map: it is the helix of its paper") {
    // t = 0.5: angle 2 pi (1/6 + 1 - 0.75) = 5 pi / 6, amplitude 1/8; cos = -sqrt(3)/2, sin = 1/2.
    const auto c = cubehelix(0.5f);
    CHECK(c[0] == doctest::Approx(0.5 + (0.14861 * std::sqrt(3.0) / 2 + 1.78277 / 2) / 8));
    CHECK(c[1] == doctest::Approx(0.5 + (0.29227 * std::sqrt(3.0) / 2 - 0.90649 / 2) / 8));
    CHECK(c[2] == doctest::Approx(0.5 - 1.97294 * std::sqrt(3.0) / 2 / 8));
}

TEST_CASE("heat map: what is no number is magenta, and a scale of four decades has its ends") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<float> errors{0, 1e-3f, 0.1f, 10, 50, nan};
    const std::vector<float> scaled = on_log_scale(errors);
    CHECK(scaled[0] == 0);
    CHECK(scaled[1] == doctest::Approx(0));
    CHECK(scaled[2] == doctest::Approx(0.5));
    CHECK(scaled[3] == doctest::Approx(1));
    CHECK(scaled[4] == doctest::Approx(1));
    const std::vector<std::uint8_t> rgb = heat_map(scaled);
    CHECK(std::vector<std::uint8_t>(rgb.begin() + 15, rgb.end()) ==
          std::vector<std::uint8_t>{255, 0, 255});
    CHECK(std::vector<std::uint8_t>(rgb.begin(), rgb.begin() + 3) ==
          std::vector<std::uint8_t>{0, 0, 0});
}
