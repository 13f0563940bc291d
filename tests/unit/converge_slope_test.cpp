#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "renderer/converge/summary.h"
#include "tests/support/converge_records.h"

using namespace tessera;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::vector<const ConvergeRun*> pointers(const std::vector<ConvergeRun>& runs) {
    std::vector<const ConvergeRun*> out;
    for (const ConvergeRun& r : runs) out.push_back(&r);
    return out;
}

}  // namespace

TEST_CASE("slope: a power law has its exponent, without doubt") {
    std::vector<double> x, y;
    for (int i = 1; i < 9; ++i) x.push_back(0.3 * i), y.push_back(5 * std::pow(0.3 * i, -0.75));
    const Ranged s = fit_slope(x, y);
    REQUIRE(s.known);
    REQUIRE(s.bounded);
    CHECK(s.value == doctest::Approx(-0.75));
    CHECK(s.high - s.low < 1e-12);
}

TEST_CASE("slope: value and interval are those worked out by hand") {
    // ln x = 0 1 2 3, ln y = 0 -1 -1 -2: Sxx = 5, Sxy = -3, residuals .1 -.3 .3 -.1, their squares'
    // sum .2; standard error sqrt(.2 / 2 / 5) = .141421, t(2) = 4.302653.
    const std::vector<double> x{1, std::exp(1.0), std::exp(2.0), std::exp(3.0)};
    const std::vector<double> y{1, std::exp(-1.0), std::exp(-1.0), std::exp(-2.0)};
    const Ranged s = fit_slope(x, y);
    CHECK(s.value == doctest::Approx(-0.6));
    CHECK(s.high - s.value == doctest::Approx(4.302653 * 0.1414214).epsilon(1e-6));
    CHECK(s.value - s.low == doctest::Approx(4.302653 * 0.1414214).epsilon(1e-6));
}

TEST_CASE("slope: pairs that have no logarithm are left out") {
    const std::vector<double> x{1, 0, 10, -3, 100, kNan, 5, kInf};
    const std::vector<double> y{1, 1, 0.1, 1, 0.01, 1, 0, 1};
    const Ranged s = fit_slope(x, y);
    CHECK(s.value == doctest::Approx(-1));
    CHECK(s.bounded);
}

TEST_CASE("slope: two points have no interval, fewer or equal ones nothing") {
    CHECK(fit_slope(std::vector<double>{1, 10}, std::vector<double>{1, 0.1}).value ==
          doctest::Approx(-1));
    CHECK_FALSE(fit_slope(std::vector<double>{1, 10}, std::vector<double>{1, 0.1}).bounded);
    CHECK_FALSE(fit_slope(std::vector<double>{2}, std::vector<double>{1}).known);
    CHECK_FALSE(fit_slope(std::vector<double>{}, std::vector<double>{}).known);
    CHECK_FALSE(fit_slope(std::vector<double>{2, 2, 2}, std::vector<double>{1, 2, 3}).known);
}

TEST_CASE("slope: over seeds it is the mean, with an interval from two on") {
    const std::vector<Ranged> one{{-1, -1.5, -0.5, true, true}};
    CHECK(over_seeds(one).low == -1.5);
    const std::vector<Ranged> two{{-1.1, 0, 0, true, false}, {-0.9, 0, 0, true, false}, {}};
    const Ranged s = over_seeds(two);
    CHECK(s.value == doctest::Approx(-1));
    // standard error 0.1, t(1) = 12.7062
    CHECK(s.high == doctest::Approx(-1 + 0.1 * 12.7062).epsilon(1e-5));
    CHECK_FALSE(over_seeds(std::vector<double>{kNan, kInf}).known);
}

TEST_CASE("converge summary: a series has its runs' means, slope, efficiency and rates") {
    ConvergeScene scene;
    scene.runs = {run_of("a", 0), run_of("b", 0), run_of("a", 1, 3)};
    const std::vector<SeriesSummary> all = summarise(scene);
    REQUIRE(all.size() == 2);
    CHECK(all[0].label == "a");
    CHECK(all[0].runs == std::vector<std::size_t>{0, 2});
    CHECK(all[0].truth[0].value == doctest::Approx(2 * 8.4 / 64));
    CHECK(all[0].truth[0].bounded);
    CHECK_FALSE(all[1].truth[0].bounded);
    CHECK(all[1].wall_slope.value == doctest::Approx(-1));
    CHECK(all[1].spp_slope.value == doctest::Approx(-1));
    CHECK(all[1].efficiency.value == doctest::Approx(1 / (8.4 / 64 * 0.64)));
    CHECK(all[1].rays_per_s == doctest::Approx(64000 / 0.64));
    CHECK(all[1].memory_peak == 64 << 20);
    CHECK(*all[1].cpu_s == doctest::Approx(1.28));
    CHECK(all[1].comparable);
}

TEST_CASE("converge summary: without a reference the estimate stands in, with its interval") {
    ConvergeScene scene;
    scene.runs = {run_of("a")};
    for (ConvergePoint& p : scene.runs[0].curve) p.truth.reset();
    const SeriesSummary s = summarise(scene).at(0);
    CHECK_FALSE(s.comparable);
    CHECK_FALSE(s.truth[0].known);
    CHECK(s.estimate[0].value == doctest::Approx(0.125));
    CHECK(s.efficiency.low == doctest::Approx(1 / (0.125 * 1.25 * 0.64)));
    CHECK(s.efficiency.high == doctest::Approx(1 / (0.125 / 1.25 * 0.64)));
    CHECK(mean_curve(pointers(scene.runs), ErrorKind::flip).empty());
}

TEST_CASE("converge summary: a series that failed is left out, its neighbours stay") {
    ConvergeScene scene;
    scene.runs = {ConvergeRun{}, run_of("b")};
    scene.runs[0].series = "a";
    const std::vector<SeriesSummary> all = summarise(scene);
    REQUIRE(all.size() == 1);
    CHECK(all[0].label == "b");
    CHECK(all[0].runs == std::vector<std::size_t>{1});
}

TEST_CASE("converge summary: between points of another seed lies a straight line in logarithms") {
    std::vector<ConvergeRun> runs{run_of("a"), run_of("a", 1)};
    runs[1].curve.clear();
    // 8.4 / spp again, at other samples, ending before the first does
    for (const int spp : {2, 11, 48}) {
        runs[1].curve.push_back(point_of(spp, 0.01 * spp, 8.0 / spp));
        runs[1].curve.back().truth = TrueError{1, 8.4 / spp, 1};
    }
    const std::vector<MeanPoint> curve = mean_curve(pointers(runs), ErrorKind::relmse);
    REQUIRE(curve.size() == 5);
    CHECK(curve[0].spp == 4);
    CHECK(curve[3].spp == 32);
    CHECK(curve[4].spp == 48);
    for (const MeanPoint& p : curve) {
        CHECK(p.error.value == doctest::Approx(8.4 / p.spp));
        CHECK(p.wall_s == doctest::Approx(0.01 * p.spp));
    }
}
