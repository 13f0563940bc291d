#pragma once
// Refraction that depends on the wavelength, for paths that carry red, green and blue: a path takes
// one wavelength where light is first bent apart, and is tinted by it from there on.

#include <algorithm>

#include "renderer/core/vec.h"

namespace tessera {

inline constexpr float kShortestWave = 0.39f, kLongestWave = 0.69f;  // micrometres

/// Index at a wavelength by Cauchy's two terms, from that of the sodium line and the Abbe number.
/// OpenPBR 1.1, "Dispersion".
inline float dispersed_ior(float ior, float abbe, float wave) {
    constexpr float kD = 0.5893f, kF = 0.4861f, kC = 0.6563f;
    const float b = (ior - 1.0f) / (abbe * (1.0f / (kF * kF) - 1.0f / (kC * kC)));
    return std::max(ior + b * (1.0f / (wave * wave) - 1.0f / (kD * kD)), std::min(ior, 1.0f));
}

/// How red, green and blue answer to a wavelength: never negative, each with mean one over the
/// visible band, so that what is bent apart and falls together again is white.
Color wave_response(float wave);

}  // namespace tessera
