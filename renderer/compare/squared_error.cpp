#include "renderer/compare/squared_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera {
namespace {

double relative_square(double difference, double reference, double epsilon) {
    const double square = difference * difference, scale = reference * reference + epsilon;
    if (scale > 0) return square / scale;
    return square > 0 ? std::numeric_limits<double>::infinity() : 0;
}

double mean_of_the_best(std::vector<float> values) {
    const auto left_out = static_cast<std::size_t>(static_cast<double>(values.size()) * kTrimmed);
    const std::size_t kept = values.size() - left_out;
    if (left_out > 0)
        std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(kept),
                         values.end());
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i) sum += static_cast<double>(values[i]);
    return sum / static_cast<double>(kept);
}

}  // namespace

ReferenceScale scale_of(const PictureView& reference) {
    ReferenceScale scale;
    double sum = 0;
    for (const float v : reference.values) {
        sum += static_cast<double>(v);
        scale.peak = std::max(scale.peak, static_cast<double>(v));
    }
    const double mean =
        reference.values.empty() ? 0 : sum / static_cast<double>(reference.values.size());
    scale.epsilon = kRelativeEpsilon * mean * mean;
    return scale;
}

SquaredErrors squared_errors(const PictureView& a, const PictureView& reference, double epsilon) {
    SquaredErrors out;
    const std::size_t pixels = a.pixels();
    const auto channels = static_cast<std::size_t>(a.channels);
    out.squares.resize(pixels);
    double sum = 0, relative_sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        double relative = 0;
        for (std::size_t c = 0; c < channels; ++c) {
            const auto r = static_cast<double>(reference.values[i * channels + c]);
            const double d = static_cast<double>(a.values[i * channels + c]) - r;
            sum += d * d;
            relative += relative_square(d, r, epsilon);
        }
        relative_sum += relative;
        out.squares[i] = static_cast<float>(relative / static_cast<double>(channels));
    }
    const auto values = static_cast<double>(pixels * channels);
    out.rmse = std::sqrt(sum / values);
    out.relmse = relative_sum / values;
    out.trimmed_relmse = mean_of_the_best(out.squares);
    return out;
}

double psnr(double rmse, double peak) noexcept { return 20 * std::log10(peak / rmse); }

}  // namespace tessera
