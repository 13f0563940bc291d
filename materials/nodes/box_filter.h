#pragma once
// Means of functions of one variable over a box, in closed form: what a regular pattern looks like
// through a footprint.

#include "materials/nodes/lattice.h"

namespace tessera {

/// Mean of a function of period 1 over [x - w/2, x + w/2]. at(t) is the function, upto(t) its
/// integral from 0 to t, both for t in [0, 1].
template <class At, class Upto>
float periodic_mean(float x, float w, At at, Upto upto) {
    const float start = x - std::floor(x);
    // Below this the difference of the integrals is mostly rounding.
    if (w < 1e-3f) return at(start);
    if (w > 1e6f) return upto(1.0f);
    const float lo = start - 0.5f * w, hi = start + 0.5f * w;
    const float lo_floor = std::floor(lo), hi_floor = std::floor(hi);
    const float whole = upto(1.0f) * (hi_floor - lo_floor);
    return (whole + upto(hi - hi_floor) - upto(lo - lo_floor)) / w;
}

/// Share of the box in which x mod 1 lies in [a, b), 0 <= a <= b <= 1. The box's w may be 0.
inline float pulse_mean(float x, float w, float a, float b) {
    return periodic_mean(
        x, w, [&](float t) { return t >= a && t < b ? 1.0f : 0.0f; },
        [&](float t) { return std::clamp(t, a, b) - a; });
}

}  // namespace tessera
