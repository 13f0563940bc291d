// Passes against a simulated clock.
#include "renderer/integrator/pass_plan.h"

#include <doctest/doctest.h>

#include <functional>
#include <utility>

#include "tests/support/random.h"

using namespace tessera;

namespace {

constexpr int kSpp = 1 << 24;

struct Run {
    double seconds = 0;
    int samples = 0, passes = 0;
};

// each: what a sample of the next pass takes, given the time so far.
Run run(double time_s, const std::function<double(double)>& each) {
    PassPlan plan(kSpp, time_s);
    Run r;
    while (const int n = plan.next(r.samples, r.seconds)) {
        const double took = n * each(r.seconds);
        plan.took(n, took);
        r.seconds += took, r.samples += n, ++r.passes;
        REQUIRE(r.passes < 100);
    }
    return r;
}

// Shares of the time that a sample takes, up to 5 %.
constexpr double kCosts[]{1e-6, 1e-4, 1e-3, 3e-3, 0.01, 0.02, 0.03, 0.05};

}  // namespace

TEST_CASE("pass plan: speeds that vary by a tenth end within 3 % of the time and use 90 % of it") {
    Random random(7);
    for (const double cost : kCosts) {
        for (int i = 0; i < 500; ++i) {
            const Run r = run(60, [&](double) {
                return 60 * cost * (0.9 + 0.2 * static_cast<double>(random.unit()));
            });
            INFO(cost, " ", i);
            REQUIRE(r.seconds <= 1.03 * 60);
            REQUIRE(r.seconds >= 0.9 * 60);
        }
    }
}

TEST_CASE("pass plan: a machine that gets twice as slow at any moment is hardly late") {
    for (const double cost : {1e-5, 1e-3, 0.01}) {
        for (double moment = 0; moment < 60; moment += 0.37) {
            const Run r =
                run(60, [&](double now) { return 60 * cost * (now < moment ? 1.0 : 2.0); });
            INFO(cost, " ", moment);
            REQUIRE(r.seconds <= 1.04 * 60);
        }
    }
}

TEST_CASE("pass plan: a first sample that takes longer, as images are read, wastes no time") {
    bool first = true;
    const Run r = run(60, [&](double) { return std::exchange(first, false) ? 10.0 : 0.01; });
    CHECK(r.seconds > 0.95 * 60);
    CHECK(r.seconds < 1.03 * 60);
    CHECK(r.samples > 4500);
}

TEST_CASE("pass plan: there is always one sample, and never more than asked for") {
    PassPlan plan(7, 1);
    CHECK(plan.next(0, 0.9) == 1);
    plan.took(1, 50);
    CHECK(plan.next(1, 50) == 0);
    PassPlan quick(7, 1e6);
    quick.took(3, 1e-9);
    CHECK(quick.next(3, 0) == 4);
    CHECK(quick.next(7, 0) == 0);
    quick.took(1, 0);  // a clock that stands still
    CHECK(quick.next(0, 0) == 7);
}

TEST_CASE("pass plan: without a time passes grow fourfold up to the samples asked for") {
    const PassPlan plan(100, 0);
    CHECK(plan.next(0, 0) == 1);
    CHECK(plan.next(1, 0) == 3);
    CHECK(plan.next(4, 0) == 12);
    CHECK(plan.next(7, 0) == 9);  // resumed
    CHECK(plan.next(16, 0) == 48);
    CHECK(plan.next(85, 0) == 15);
    CHECK(plan.next(100, 0) == 0);
    CHECK(PassPlan(1 << 24, 0).next((1 << 24) - 1, 0) == 1);
}

TEST_CASE("pass plan: close passes end at powers of two, with a time too") {
    PassPlan plan(100, 0, true);
    CHECK(plan.next(0, 0) == 1);
    CHECK(plan.next(1, 0) == 1);
    CHECK(plan.next(2, 0) == 2);
    CHECK(plan.next(32, 0) == 32);
    CHECK(plan.next(64, 0) == 36);
    PassPlan timed(1 << 20, 1e6, true);
    timed.took(64, 1e-3);
    CHECK(timed.next(64, 0) == 64);
}
