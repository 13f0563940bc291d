#include "renderer/error/forecast.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace tessera;

namespace {

// Errors that fall with a power of the samples, of a quarter of a second each after one of loading.
std::vector<ErrorPoint> falling(double power, double spread, int points = 4) {
    std::vector<ErrorPoint> curve;
    for (int k = 0, spp = 4; k < points; ++k, spp *= 2) {
        const double e = std::pow(spp, -power), factor = std::exp(1.96 * spread);
        const Interval relmse{e, e / factor, e * factor, true};
        const Interval rmse{std::sqrt(e), std::sqrt(relmse.low), std::sqrt(relmse.high), true};
        curve.push_back({spp, 1 + 0.25 * spp, 2 + 0.5 * spp, rmse, relmse, {}});
    }
    return curve;
}

}  // namespace

TEST_CASE("forecast: independent samples need four times as many for a quarter of the error") {
    const ErrorForecast f = forecast(falling(1, 0.001), {true, 1.0 / 128});
    CHECK(f.spp.value == doctest::Approx(128).epsilon(0.01));
    CHECK(f.wall_s.value == doctest::Approx(33).epsilon(0.01));
    CHECK(f.spp.low < 128);
    CHECK(f.spp.high > 128);
    CHECK(f.wall_s.reliable);
    // The same of the root.
    CHECK(forecast(falling(1, 0.001), {false, std::sqrt(1.0 / 128)}).spp.value ==
          doctest::Approx(128).epsilon(0.01));
}

TEST_CASE("forecast: a steeper curve is followed as far as it is known") {
    // Of the root, whose interval stays as wide as it is.
    const auto samples = [](double spread) {
        const double goal = std::pow(512, -1.3) * std::exp(1.96 * spread);
        return forecast(falling(1.3, spread, 6), {false, std::sqrt(goal)}).spp.value;
    };
    CHECK(samples(0.001) == doctest::Approx(512).epsilon(0.02));
    CHECK(samples(0.5) > 1.2 * 512);  // nearer to the usual power
}

TEST_CASE("forecast: the upper end of the interval is what has to come down") {
    const std::vector<ErrorPoint> curve = falling(1.1, 0.1);
    const double root = forecast(curve, {false, 0.1}).spp.value, sharp = std::pow(100, 1 / 1.1);
    CHECK(root == doctest::Approx(sharp * std::exp(0.196 / 1.1)).epsilon(0.01));
    // That of a relative error comes nearer on the way.
    const double relative = forecast(curve, {true, 0.01}).spp.value;
    CHECK(relative > 1.05 * sharp);
    CHECK(relative < 0.95 * root);
}

TEST_CASE("forecast: what is reached is reached, what is black is not forecast") {
    const std::vector<ErrorPoint> curve = falling(1, 0.1);
    CHECK(reached(curve.back(), {true, 0.1}));
    CHECK_FALSE(
        reached(curve.back(), {true, 0.033}));  // the value is below it, the upper end is not
    CHECK(forecast(curve, {true, 0.1}).wall_s.value == curve.back().wall_s);
    std::vector<ErrorPoint> unreliable = curve;
    unreliable.back().relmse.reliable = false;
    CHECK_FALSE(reached(unreliable.back(), {true, 0.1}));
    CHECK(forecast({}, {true, 0.1}).spp.value == 0);
    CHECK(forecast({ErrorPoint{4, 1, 1, {}, {}, {}}}, {true, 0.1}).spp.value == 0);
}
