#include "renderer/compare/seed_interval.h"

#include <cmath>
#include <numbers>

namespace tessera {
namespace {

// Probability of |variable| < t: the finite sums of Abramowitz & Stegun 26.7.3, 26.7.4.
double within(double t, int n) {
    const double angle = std::atan(t / std::sqrt(static_cast<double>(n)));
    const double c = std::cos(angle), s = std::sin(angle);
    double term = n % 2 ? c : 1, sum = n > 1 ? term : 0;
    for (int k = n % 2 ? 3 : 2; k < n; k += 2) {
        term *= c * c * (k - 1) / k;
        sum += term;
    }
    return n % 2 ? 2 / std::numbers::pi * (angle + s * sum) : s * sum;
}

}  // namespace

double student_t(int n) noexcept {
    double low = 0, high = 16;  // 12.7 for n = 1
    for (int i = 0; i < 60; ++i) {
        const double t = (low + high) / 2;
        (within(t, n) < 0.95 ? low : high) = t;
    }
    return high;
}

SeedInterval seed_interval(std::span<const double> values) {
    SeedInterval out;
    out.count = static_cast<int>(values.size());
    if (values.empty()) return out;
    double sum = 0, squares = 0;
    for (const double v : values) sum += v;
    out.mean = out.low = out.high = sum / out.count;
    if (out.count < 2 || !std::isfinite(out.mean)) return out;
    for (const double v : values) squares += (v - out.mean) * (v - out.mean);
    const double error = std::sqrt(squares / (out.count - 1) / out.count);
    const double half = student_t(out.count - 1) * error;
    out.low -= half, out.high += half;
    return out;
}

Closer closer(const SeedInterval& a, const SeedInterval& b, bool less_is_closer) noexcept {
    if (a.count < 2 || b.count < 2) return Closer::unknown;
    if (a.high < b.low) return less_is_closer ? Closer::a : Closer::b;
    if (b.high < a.low) return less_is_closer ? Closer::b : Closer::a;
    return Closer::unknown;
}

}  // namespace tessera
