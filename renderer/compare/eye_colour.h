#pragma once
// The colour spaces of FLIP. Linear Rec. 709 in 0..1, white D65.

#include <array>

#include "renderer/compare/vector_math.h"
#include "renderer/core/cie.h"

namespace tessera {

using Colour3 = std::array<float, 3>;

/// XYZ over that of white. IEC 61966-2-1.
inline Colour3 xyz_over_white(float r, float g, float b) {
    return {(0.4124564f * r + 0.3575761f * g + 0.1804375f * b) / 0.9504700f,
            0.2126729f * r + 0.7151522f * g + 0.0721750f * b,
            (0.0193339f * r + 0.1191920f * g + 0.9503041f * b) / 1.0888300f};
}

inline Colour3 rgb_of_xyz_over_white(float x, float y, float z) {
    const auto row = [&](const Vec3d& v) {
        return static_cast<float>(v.x) * 0.9504700f * x + static_cast<float>(v.y) * y +
               static_cast<float>(v.z) * 1.0888300f * z;
    };
    return {row(kXyzToRed), row(kXyzToGreen), row(kXyzToBlue)};
}

/// Linear opponent space: achromatic, red-green, blue-yellow (FLIP, section 4.1).
inline Colour3 to_opponent(float r, float g, float b) {
    const Colour3 t = xyz_over_white(r, g, b);
    return {116 * t[1] - 16, 500 * (t[0] - t[1]), 200 * (t[1] - t[2])};
}

/// Out of gamut is clamped to 0..1.
inline Colour3 from_opponent(float achromatic, float red_green, float blue_yellow) {
    const float y = (achromatic + 16) * (1 / 116.0f);
    const Colour3 c =
        rgb_of_xyz_over_white(red_green * (1 / 500.0f) + y, y, y - blue_yellow * (1 / 200.0f));
    return {std::min(std::max(c[0], 0.0f), 1.0f), std::min(std::max(c[1], 0.0f), 1.0f),
            std::min(std::max(c[2], 0.0f), 1.0f)};
}

/// CIE 1976 L*a*b* with a* and b* scaled by 0.01 L*: dark colours differ less (Hunt; section 4.1).
inline Colour3 to_hunt_lab(float r, float g, float b) {
    const Colour3 t = xyz_over_white(r, g, b);
    constexpr float kD = 6.0f / 29;
    const auto f = [](float v) {
        const float root = power_of(v, 1 / 3.0f), line = v / (3 * kD * kD) + 4 / 29.0f;
        return v > kD * kD * kD ? root : line;
    };
    const float x = f(t[0]), y = f(t[1]), z = f(t[2]);
    const float l = 116 * y - 16, hunt = 0.01f * l;
    return {l, hunt * 500 * (x - y), hunt * 200 * (y - z)};
}

/// Distance of colours far apart: Abasi, Tehran, Fairchild, "Distance Metrics for Very Large Color
/// Differences", 2020.
inline float hyab(const Colour3& a, const Colour3& b) {
    const float da = a[1] - b[1], db = a[2] - b[2];
    return std::fabs(a[0] - b[0]) + std::sqrt(da * da + db * db);
}

}  // namespace tessera
