#include "renderer/compare/heat_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tessera {

std::array<float, 3> cubehelix(float t) noexcept {
    const double x = std::clamp(static_cast<double>(t), 0.0, 1.0);
    const double angle = 2 * std::numbers::pi * (0.5 / 3 + 1 - 1.5 * x);
    const double amplitude = x * (1 - x) / 2;
    const double c = amplitude * std::cos(angle), s = amplitude * std::sin(angle);
    // Green 2011, eq. 2
    const auto channel = [&](double of_cos, double of_sin) {
        return static_cast<float>(std::clamp(x + of_cos * c + of_sin * s, 0.0, 1.0));
    };
    return {channel(-0.14861, 1.78277), channel(-0.29227, -0.90649), channel(1.97294, 0)};
}

std::vector<std::uint8_t> heat_map(std::span<const float> values) {
    std::vector<std::uint8_t> out;
    out.reserve(values.size() * 3);
    for (const float v : values) {
        const std::array<float, 3> rgb =
            std::isfinite(v) ? cubehelix(v) : std::array<float, 3>{1, 0, 1};
        for (const float c : rgb) out.push_back(static_cast<std::uint8_t>(c * 255 + 0.5f));
    }
    return out;
}

std::vector<float> on_log_scale(std::span<const float> relative_errors) {
    std::vector<float> out;
    out.reserve(relative_errors.size());
    for (const float e : relative_errors) {
        const float clamped = std::clamp(e, kLeastShown, kMostShown);
        out.push_back(std::isnan(e) ? e
                                    : std::log10(clamped / kLeastShown) /
                                          std::log10(kMostShown / kLeastShown));
    }
    return out;
}

}  // namespace tessera
