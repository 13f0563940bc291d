#pragma once
// The normal distribution, to about three digits: enough for how a texture spreads about its mean.

#include <algorithm>
#include <cmath>

#include "renderer/core/vec.h"

namespace tessera {

/// Chance of a standard normal value below x. Abramowitz & Stegun 7.1.27, error below 2.5e-4.
inline float normal_cdf(float x) {
    const float z = std::min(std::fabs(x) * 0.70710678f, 1e4f);
    const float p = 1.0f + z * (0.278393f + z * (0.230389f + z * (0.000972f + z * 0.078108f)));
    const float tail = 0.5f / sqr(sqr(p));
    return x < 0.0f ? tail : 1.0f - tail;
}

/// The value below which a share of standard normal values lies; share is clamped to [1e-6, 1 -
/// 1e-6]. Abramowitz & Stegun 26.2.23, error below 4.5e-4.
inline float normal_quantile(float share) {
    const float tail = std::clamp(std::min(share, 1.0f - share), 1e-6f, 0.5f);
    const float t = std::sqrt(-2.0f * std::log(tail));
    const float x = t - (2.515517f + t * (0.802853f + t * 0.010328f)) /
                            (1.0f + t * (1.432788f + t * (0.189269f + t * 0.001308f)));
    return share < 0.5f ? -x : x;
}

/// Mean of those standard normal values that lie above -z, the inverse Mills ratio at z. Abramowitz
/// & Stegun 26.2.12 in the far tail; error below 3%.
inline float mean_above(float z) {
    if (z < -2.5f) return -z - 1.0f / z + 2.0f / (z * z * z);
    return 0.39894228f * std::exp(-0.5f * sqr(z)) / normal_cdf(z);
}

/// Mean of exp(-x^2 / (2 h^2)) over x of this mean and variance, normally distributed.
inline float mean_bump(float mean, float variance, float h) {
    const float total = sqr(h) + variance;
    return h / std::sqrt(total) * std::exp(-0.5f * sqr(mean) / total);
}

}  // namespace tessera
