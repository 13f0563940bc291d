#pragma once
// Elementary functions of our own where the loop needs them: branch-free, the same bits on every
// machine.

#include <bit>
#include <cmath>
#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

struct SinCos {
    float sin, cos;
};

/// sin and cos of 2 pi u, u in [0, 1]. Absolute error below 1.5e-7 (Taylor to degree 9/8 on [-pi/4,
/// pi/4]).
inline SinCos sincos_turn(float u) {
    const float quarter = std::floor(u * 4.0f + 0.5f);
    const float x = (u - quarter * 0.25f) * (2.0f * kPi);
    const float x2 = x * x;
    const float s =
        x * (1.0f + x2 * (-1.66666667e-1f +
                          x2 * (8.33333333e-3f + x2 * (-1.98412698e-4f + x2 * 2.7557319e-6f))));
    const float c =
        1.0f + x2 * (-0.5f + x2 * (4.16666667e-2f + x2 * (-1.38888889e-3f + x2 * 2.48015873e-5f)));
    const int q = static_cast<int>(quarter) & 3;
    const float ss = (q & 1) ? c : s;
    const float cc = (q & 1) ? s : c;
    return {(q & 2) ? -ss : ss, (q == 1 || q == 2) ? -cc : cc};
}

/// acos on [-1, 1] (clamped). Abramowitz & Stegun 4.4.46: absolute error below 2e-7.
inline float acos_poly(float x) {
    const float a = std::min(std::fabs(x), 1.0f);
    float p = -0.0012624911f;
    p = p * a + 0.0066700901f;
    p = p * a - 0.0170881256f;
    p = p * a + 0.0308918810f;
    p = p * a - 0.0501743046f;
    p = p * a + 0.0889789874f;
    p = p * a - 0.2145988016f;
    p = p * a + 1.5707963050f;
    const float r = std::sqrt(1.0f - a) * p;
    return x < 0.0f ? kPi - r : r;
}

/// atan2(y, x) / (2 pi), in [-0.5, 0.5]; 0 for (0, 0). Abramowitz & Stegun 4.4.49: error below 1e-8
/// turns and rounding.
inline float atan2_turn(float y, float x) {
    const float ax = std::fabs(x), ay = std::fabs(y);
    const float big = std::max(ax, ay);
    const float z = big > 0.0f ? std::min(ax, ay) / big : 0.0f, z2 = z * z;
    float p = 0.0028662257f;
    p = p * z2 - 0.0161657367f;
    p = p * z2 + 0.0429096138f;
    p = p * z2 - 0.0752896400f;
    p = p * z2 + 0.1065626393f;
    p = p * z2 - 0.1420889944f;
    p = p * z2 + 0.1999355085f;
    p = p * z2 - 0.3333314528f;
    float turn = (p * z2 + 1.0f) * z * (0.5f * kInvPi);
    if (ay > ax) turn = 0.25f - turn;
    if (x < 0.0f) turn = 0.5f - turn;
    return y < 0.0f ? -turn : turn;
}

}  // namespace tessera
