#include <algorithm>
#include <cmath>

#include "renderer/compare/flip.h"
#include "renderer/compare/tone_curve.h"

namespace tessera {
namespace {

constexpr double kShown = 0.85;  // what the brightest and the median are shown as
constexpr int kMost = 32;        // exposures; beyond, they lie more than a stop apart

}  // namespace

double inverse_tone_curve(double t) noexcept {
    const double a = 2.51 - t * 2.43, b = 0.03 - t * 0.59, c = -t * 0.14;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / 0.6;
}

// Eurographics 2021, section 3.2. The median is that of pixels with light: a picture that is black
// for the most part has none otherwise.
std::vector<double> flip_exposures(const PictureView& reference) {
    std::vector<float> light;
    for (std::size_t i = 0; i < reference.pixels(); ++i) {
        const std::span<const float> p = reference.pixel(i);
        const float y = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
        if (y > 0) light.push_back(y);
    }
    if (light.empty()) return {0.0};
    const auto middle = light.begin() + static_cast<std::ptrdiff_t>(light.size() / 2);
    std::nth_element(light.begin(), middle, light.end());
    const double median = static_cast<double>(*middle);
    const double most = static_cast<double>(*std::max_element(light.begin(), light.end()));
    const double target = inverse_tone_curve(kShown);
    const double start = std::log2(target / most), stop = std::log2(target / median);
    const int count = std::clamp(static_cast<int>(std::ceil(stop - start)), 2, kMost);
    if (stop - start < 1e-6) return {start};
    std::vector<double> exposures;
    for (int i = 0; i < count; ++i) exposures.push_back(start + (stop - start) * i / (count - 1));
    return exposures;
}

}  // namespace tessera
