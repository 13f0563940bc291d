#include "renderer/compare/seed_interval.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace tessera;

TEST_CASE("seed interval: Student's t is that of the tables") {
    CHECK(student_t(1) == doctest::Approx(12.7062).epsilon(1e-5));
    CHECK(student_t(2) == doctest::Approx(4.30265).epsilon(1e-5));
    CHECK(student_t(3) == doctest::Approx(3.18245).epsilon(1e-5));
    CHECK(student_t(4) == doctest::Approx(2.77645).epsilon(1e-5));
    CHECK(student_t(9) == doctest::Approx(2.26216).epsilon(1e-5));
    CHECK(student_t(30) == doctest::Approx(2.04227).epsilon(1e-5));
    CHECK(student_t(10000) == doctest::Approx(1.9602).epsilon(1e-4));
}

TEST_CASE("seed interval: of three values it is as by hand, of one it is a point") {
    const std::array<double, 3> three{1, 2, 3};
    const SeedInterval i = seed_interval(three);
    CHECK(i.mean == 2);
    CHECK(i.high - i.mean == doctest::Approx(4.30265 / std::sqrt(3.0)).epsilon(1e-5));
    CHECK(i.mean - i.low == doctest::Approx(i.high - i.mean));
    const std::array<double, 1> one{7};
    CHECK(seed_interval(one).low == 7);
    CHECK(seed_interval(one).high == 7);
    const std::array<double, 2> infinite{1, std::numeric_limits<double>::infinity()};
    CHECK(std::isinf(seed_interval(infinite).low));
}

TEST_CASE("seed interval: it holds the expectation in 95 of 100 cases") {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(3, 1);
    constexpr int kCases = 4000;
    int held = 0;
    for (int i = 0; i < kCases; ++i) {
        std::vector<double> values(4);
        for (double& v : values) v = noise(random);
        const SeedInterval interval = seed_interval(values);
        held += interval.low < 3 && 3 < interval.high;
    }
    // 4 sigma of a share of 0.95 in 4000 cases
    CHECK(std::fabs(held / double{kCases} - 0.95) < 4 * std::sqrt(0.95 * 0.05 / kCases));
}

TEST_CASE("seed interval: no verdict where they overlap or where one is a point") {
    const SeedInterval low{1, 0.9, 1.1, 3}, high{2, 1.8, 2.2, 3}, wide{1.5, 1.0, 2.0, 3};
    CHECK(closer(low, high, true) == Closer::a);
    CHECK(closer(high, low, true) == Closer::b);
    CHECK(closer(low, high, false) == Closer::b);
    CHECK(closer(low, wide, true) == Closer::unknown);
    CHECK(closer(low, low, true) == Closer::unknown);
    CHECK(closer({1, 1, 1, 1}, high, true) == Closer::unknown);
}
