#pragma once
// Powers that a compiler can compute for many pixels at once. Relative error below 1e-6 for results
// between 1e-30 and 1e30.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace tessera {

/// x a positive normal number. atanh series of the mantissa within 1/sqrt(2) .. sqrt(2).
inline float log2_of(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x);
    const std::int32_t exponent = (bits - 0x3f3504f3) >> 23;
    const float m = std::bit_cast<float>(bits - (exponent << 23));
    const float s = (m - 1) / (m + 1), s2 = s * s;
    const float ln = 2 * s * (1 + s2 * (1 / 3.0f + s2 * (0.2f + s2 * (1 / 7.0f + s2 / 9))));
    return static_cast<float>(exponent) + ln * 1.44269504f;
}

/// Taylor series about the nearest whole number.
inline float exp2_of(float x) {
    const float clamped = std::min(std::max(x, -126.0f), 126.0f);
    const float whole = std::floor(clamped + 0.5f), t = (clamped - whole) * 0.693147181f;
    const float p =
        1 +
        t * (1 + t * (1 / 2.0f + t * (1 / 6.0f + t * (1 / 24.0f + t * (1 / 120.0f + t / 720)))));
    return p * std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23);
}

/// 0 for x <= 1e-37.
inline float power_of(float x, float exponent) {
    const float safe = std::max(x, 1e-37f);
    const float p = exp2_of(exponent * log2_of(safe));
    return x > 1e-37f ? p : 0.0f;
}

}  // namespace tessera
