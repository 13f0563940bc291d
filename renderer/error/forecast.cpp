#include "renderer/error/forecast.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr double kSlope = 1.1;        // minus the exponent of squared errors: that of most pictures
constexpr double kSlopeSpread = 0.1;  // how far pictures are from it
constexpr double kQuantile = 1.96;
// Intervals of relative errors narrow with this power of the samples, for the truth is known
// better; others do not.
constexpr double kNarrowing = 0.5;
constexpr double kPace = 0.03;  // spread of how long a sample takes later

// Logarithms of a squared error, its upper end, and the error's standard deviation.
struct Logs {
    double error, upper, spread;
};

Logs logs(const ErrorPoint& p, const ErrorTarget& t) {
    const Interval& i = of_target(p, t);
    const double power = t.relative ? 1 : 2, upper = std::log(i.high) - std::log(i.value);
    return {power * std::log(i.value), power * upper, std::max(power * upper / kQuantile, 1e-3)};
}

struct Slope {
    double value = kSlope, spread = kSlopeSpread;
};

// Between the latest point and the one a fourth of its samples ago or less, with what is known
// beforehand.
Slope slope_of(const std::vector<ErrorPoint>& curve, const ErrorTarget& target) {
    const ErrorPoint& last = curve.back();
    for (auto p = curve.rbegin(); p != curve.rend(); ++p) {
        if (4 * p->spp > last.spp || !(of_target(*p, target).value > 0)) continue;
        const Logs a = logs(*p, target), b = logs(last, target);
        const double way = std::log(static_cast<double>(last.spp) / p->spp);
        const double measured = (a.error - b.error) / way;
        const double variance = (a.spread * a.spread + b.spread * b.spread) / (way * way);
        const double prior = kSlopeSpread * kSlopeSpread;
        return {(measured * prior + kSlope * variance) / (prior + variance),
                std::sqrt(prior * variance / (prior + variance))};
    }
    return {};
}

// Seconds that a sample took lately.
double pace(const std::vector<ErrorPoint>& curve) {
    const ErrorPoint& last = curve.back();
    for (auto p = curve.rbegin(); p != curve.rend(); ++p)
        if (2 * p->spp <= last.spp) return (last.wall_s - p->wall_s) / (last.spp - p->spp);
    return last.wall_s / last.spp;
}

// Logarithm of how many times as many samples it takes; upper ends come nearer meanwhile.
double way_to(double goal, const Logs& at, double slope, double narrowing) {
    double way = 0;
    for (int i = 0; i < 20; ++i)
        way = std::max((at.error + at.upper * std::exp(-narrowing * way) - goal) / slope, 0.0);
    return way;
}

}  // namespace

const Interval& of_target(const ErrorPoint& p, const ErrorTarget& t) {
    return t.relative ? p.relmse : p.rmse;
}

bool reached(const ErrorPoint& p, const ErrorTarget& t) {
    const Interval& i = of_target(p, t);
    return i.reliable && i.high <= t.value;
}

ErrorForecast forecast(const std::vector<ErrorPoint>& curve, const ErrorTarget& target) {
    ErrorForecast out;
    if (curve.empty() || !(of_target(curve.back(), target).value > 0)) return out;
    const ErrorPoint& last = curve.back();
    if (reached(last, target)) {
        const auto spp = static_cast<double>(last.spp);
        return {{spp, spp, spp, true}, {last.wall_s, last.wall_s, last.wall_s, true}};
    }
    const Logs at = logs(last, target);
    const Slope slope = slope_of(curve, target);
    const double goal = (target.relative ? 1 : 2) * std::log(target.value);
    const double way = way_to(goal, at, slope.value, target.relative ? kNarrowing : 0);
    const double spread = std::hypot(at.spread, way * slope.spread) / slope.value;
    const double samples = last.spp * std::exp(way), factor = std::exp(kQuantile * spread);
    const auto at_least = [&](double n) { return std::max(n, static_cast<double>(last.spp)); };
    out.spp = {samples, at_least(samples / factor), samples * factor,
               of_target(last, target).reliable};
    const double each = pace(curve), late = 1 + kQuantile * kPace;
    const auto seconds = [&](double n) { return last.wall_s + (n - last.spp) * each; };
    out.wall_s = {seconds(samples), seconds(out.spp.low) / late, seconds(out.spp.high) * late,
                  out.spp.reliable};
    return out;
}

}  // namespace tessera
