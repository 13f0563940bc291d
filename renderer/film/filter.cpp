#include "renderer/film/filter.h"

#include <cmath>

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;

// Value at x in [-0.5, 0.5] of the support.
double value(PixelFilter filter, double x) {
    switch (filter) {
        case PixelFilter::box:
            return 1;
        case PixelFilter::triangle:
            return 1 - 2 * std::abs(x);
        case PixelFilter::gaussian:
            return std::exp(-18 * x * x) - std::exp(-4.5);  // sigma = width / 6
        case PixelFilter::blackman_harris: {
            // Harris, "On the Use of Windows for Harmonic Analysis", Proc. IEEE 66(1), 1978,
            // 4-term.
            const double a = 2 * kPiD * (x + 0.5);
            return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) -
                   0.01168 * std::cos(3 * a);
        }
    }
    return 1;
}

}  // namespace

FilterSampler::FilterSampler(PixelFilter filter, double width) {
    constexpr int kFine = 16384;
    double total = 0;
    for (int i = 0; i < kFine; ++i) total += value(filter, (i + 0.5) / kFine - 0.5);
    double run = 0;
    int step = 0;
    inverse_[0] = static_cast<float>(-0.5 * width);
    for (int i = 0; i < kFine; ++i) {
        const double v = value(filter, (i + 0.5) / kFine - 0.5) / total;
        while (step < kSteps && run + v >= static_cast<double>(step) / kSteps) {
            const double within = v > 0 ? (static_cast<double>(step) / kSteps - run) / v : 0;
            inverse_[step++] = static_cast<float>(((i + within) / kFine - 0.5) * width);
        }
        run += v;
    }
    for (; step <= kSteps; ++step) inverse_[step] = static_cast<float>(0.5 * width);
}

}  // namespace tessera
