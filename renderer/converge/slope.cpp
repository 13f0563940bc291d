#include "renderer/converge/slope.h"

#include <cmath>
#include <vector>

#include "renderer/compare/seed_interval.h"

namespace tessera {

Ranged fit_slope(std::span<const double> x, std::span<const double> y) {
    std::vector<std::pair<double, double>> points;
    double mean_x = 0, mean_y = 0;
    for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) {
        const double u = std::log(x[i]), v = std::log(y[i]);
        if (!std::isfinite(u) || !std::isfinite(v)) continue;
        points.emplace_back(u, v);
        mean_x += u, mean_y += v;
    }
    const auto n = static_cast<double>(points.size());
    mean_x /= n, mean_y /= n;
    double sxx = 0, sxy = 0;
    for (const auto& [u, v] : points) {
        sxx += (u - mean_x) * (u - mean_x);
        sxy += (u - mean_x) * (v - mean_y);
    }
    Ranged out;
    if (points.size() < 2 || sxx <= 0) return out;
    out.known = true;
    out.value = out.low = out.high = sxy / sxx;
    if (points.size() < 3) return out;
    double residuals = 0;
    for (const auto& [u, v] : points) {
        const double r = v - mean_y - out.value * (u - mean_x);
        residuals += r * r;
    }
    const int freedom = static_cast<int>(points.size()) - 2;
    const double half = student_t(freedom) * std::sqrt(residuals / freedom / sxx);
    out.low -= half, out.high += half;
    out.bounded = true;
    return out;
}

Ranged over_seeds(std::span<const double> values) {
    std::vector<double> finite;
    for (const double v : values)
        if (std::isfinite(v)) finite.push_back(v);
    if (finite.empty()) return {};
    const SeedInterval i = seed_interval(finite);
    return {i.mean, i.low, i.high, true, i.count > 1};
}

Ranged over_seeds(std::span<const Ranged> slopes) {
    if (slopes.size() == 1) return slopes[0];
    std::vector<double> values;
    for (const Ranged& s : slopes)
        if (s.known) values.push_back(s.value);
    return over_seeds(values);
}

}  // namespace tessera
