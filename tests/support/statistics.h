#pragma once
// Tail probabilities, and the level of one test among many.

#include <cmath>
#include <cstddef>

namespace tessera {

/// log Gamma(x), x > 0: Stirling's series after a shift. Unlike lgamma it writes to no global.
inline double log_gamma(double x) {
    double shift = 0;
    for (; x < 12; ++x) shift -= std::log(x);
    const double y = 1 / (x * x);
    const double series = (1.0 / 12 - y * (1.0 / 360 - y * (1.0 / 1260 - y / 1680))) / x;
    return shift + (x - 0.5) * std::log(x) - x + 0.91893853320467274178 + series;
}

/// Regularised upper incomplete gamma function Q(a, x). DLMF 8.11.4 (series) and 8.9.2 (continued
/// fraction).
inline double gamma_q(double a, double x) {
    if (!(x > 0)) return 1;
    const double front = std::exp(a * std::log(x) - x - log_gamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (double n = a + 1; term > sum * 1e-16; ++n) sum += term *= x / n;
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double k = -n * (n - a);
        b += 2;
        d = 1 / (k * d + b);
        c = b + k / c;
        h *= c * d;
        if (std::fabs(c * d - 1) < 1e-15) break;
    }
    return front * h;
}

/// Chance of a chi-square value at least this large.
inline double chi_square_p(double value, double degrees) {
    return gamma_q(0.5 * degrees, 0.5 * value);
}

/// Chance of a standard normal value at least this far from zero.
inline double normal_p(double z) { return std::erfc(std::fabs(z) / 1.4142135623730951); }

/// The same for Student's t. Wallace, "Bounds on Normal Approximations to Student's...", Ann. Math.
/// Stat. 30, 1959, eq. 4.
inline double student_p(double t, double degrees) {
    const double z =
        (8 * degrees + 1) / (8 * degrees + 3) * std::sqrt(degrees * std::log1p(t * t / degrees));
    return normal_p(z);
}

/// Level of each of `tests` independent tests so that one or more fails by chance with probability
/// alpha. Sidak, "Rectangular Confidence Regions...", J. Am. Stat. Assoc. 62, 1967.
inline double sidak_level(double alpha, std::size_t tests) {
    return -std::expm1(std::log1p(-alpha) / static_cast<double>(tests));
}

/// Mean and its standard error.
class Mean {
public:
    void add(double x) {
        ++n_;
        const double d = x - mean_;
        mean_ += d / static_cast<double>(n_);
        squares_ += d * (x - mean_);
    }
    double mean() const { return mean_; }
    double variance() const { return n_ > 1 ? squares_ / static_cast<double>(n_ - 1) : 0; }
    double error() const { return std::sqrt(variance() / static_cast<double>(n_)); }
    std::size_t count() const { return n_; }

private:
    std::size_t n_ = 0;
    double mean_ = 0, squares_ = 0;
};

}  // namespace tessera
