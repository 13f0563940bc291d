#pragma once
// How HDR-FLIP shows scene light: Narkowicz, "ACES Filmic Tone Mapping Curve", 2015, with its
// exposure of 0.6. Eurographics 2021, section 3.

#include <algorithm>

namespace tessera {

/// x >= 0; towards 1.03.
inline float tone_curve(float x) {
    const float e = 0.6f * std::min(x, 1e18f);  // whose square is finite
    return e * (2.51f * e + 0.03f) / (e * (2.43f * e + 0.59f) + 0.14f);
}

/// The x that gives t, 0 < t < 1.
double inverse_tone_curve(double t) noexcept;

}  // namespace tessera
