#include "renderer/error/interval.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Limits of what can be relied on.
constexpr double kPixelsBehind = 4, kDeviation = 0.35, kLargest = 0.25, kBracket = 2.0;
// How far off the relative error came out, in logarithms, over that of the ratio of its two
// estimates (docs/error.md).
constexpr double kBias = 0.2;
constexpr double kTowardLow = 0.25;  // share of the way from the higher to the lower, in logarithms
constexpr double kUnknown = 1000;  // no interval is wider than by this factor: it would say no more

void widen(Interval& i, double factor) {
    i.low = std::max(i.low / factor, i.value / kUnknown);
    i.high = std::min(i.high * factor, i.value * kUnknown);
}

// Of a picture without noise nothing is in doubt.
bool stands_on_few(const ErrorSums& s) {
    return s.error > 0 && (s.pixels_behind() < kPixelsBehind || s.largest > kLargest * s.error ||
                           std::sqrt(s.spread) > kDeviation * s.error);
}

}  // namespace

double student(double z, double degrees) noexcept {
    const double n = std::max(degrees, 1.0), z3 = z * z * z;
    return z + (z3 + z) / (4 * n) + (5 * z3 * z * z + 16 * z3 + 3 * z) / (96 * n * n);
}

Interval mean_interval(const ErrorSums& sums, double pixels, double quantile) noexcept {
    if (!(sums.error > 0)) return {};
    const double t = student(quantile, 2 * sums.pixels_behind());
    const double factor = std::min(std::exp(t * std::sqrt(sums.spread) / sums.error), kUnknown);
    const double mean = sums.error / pixels;
    return {mean, mean / factor, mean * factor, false};
}

Interval root(const Interval& i) noexcept {
    return {std::sqrt(i.value), std::sqrt(i.low), std::sqrt(i.high), i.reliable};
}

double joint_quantile(std::size_t n) noexcept {
    const double each = std::pow(0.95, 1.0 / static_cast<double>(n));
    double low = 1.0, high = 12.0;  // by bisection: the library has the error function alone
    for (int i = 0; i < 60; ++i) {
        const double q = 0.5 * (low + high);
        (std::erf(q / std::sqrt(2.0)) < each ? low : high) = q;
    }
    return 0.5 * (low + high);
}

ErrorSums relative_error(const TileError& e) noexcept {
    ErrorSums out = e.high;
    if (!(e.high.error > 0)) return out;
    const double q = std::min(e.low.error / e.high.error, 1.0);
    out.error *= std::pow(q, kTowardLow);
    return out;
}

void judge(const TileError& all, ErrorEstimate& e) {
    const bool few = stands_on_few(all.absolute);
    e.rmse.reliable = e.worst_tile.reliable = !few;
    const double bracket = all.low.error > 0 ? std::max(all.high.error / all.low.error, 1.0) : 1.0;
    const bool apart = bracket > kBracket;
    e.relmse.reliable = !apart && !stands_on_few(relative_error(all));
    widen(e.relmse, std::pow(bracket, kBias));
    if (few) e.cautions.emplace_back("few pixels make most of the error");
    if (apart) e.cautions.emplace_back("relmse: pixels are too noisy to tell how bright they are");
}

}  // namespace tessera
