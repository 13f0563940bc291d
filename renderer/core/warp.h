#pragma once
// Maps from the unit square to the domains we sample, with their densities.

#include <cmath>

#include "renderer/core/fast_math.h"
#include "renderer/core/vec.h"

namespace tessera {

/// Unit disc, polar form with equal areas; keeps strata together well enough and needs no branch.
inline Vec2f warp_disc(Vec2f u) {
    const float r = safe_sqrt(u.x);
    const SinCos a = sincos_turn(u.y);
    return {r * a.cos, r * a.sin};
}

/// Unit disc, concentric: strata stay compact. Shirley & Chiu, "A Low Distortion Map Between Disk
/// and Square", Journal of Graphics Tools 2(3), 1997.
inline Vec2f warp_disc_concentric(Vec2f u) {
    const float a = 2.0f * u.x - 1.0f, b = 2.0f * u.y - 1.0f;
    // No branch: which of the two is larger is random.
    const bool wide = std::fabs(a) > std::fabs(b);
    const float r = wide ? a : b, over = wide ? b : a;
    const float eighths = r == 0.0f ? 0.0f : 0.125f * (over / r);
    const float turn = wide ? eighths : 0.25f - eighths;
    const SinCos s = sincos_turn(turn < 0.0f ? turn + 1.0f : turn);
    return {r * s.cos, r * s.sin};
}

/// Hemisphere about +z, density cos/pi.
inline Vec3f warp_cosine(Vec2f u) {
    const Vec2f d = warp_disc_concentric(u);
    return {d.x, d.y, safe_sqrt(1.0f - d.x * d.x - d.y * d.y)};
}

/// Sphere, density 1/(4 pi).
inline Vec3f warp_sphere(Vec2f u) {
    const float z = 1.0f - 2.0f * u.x;
    const float r = 2.0f * safe_sqrt(u.x * (1.0f - u.x));
    const SinCos a = sincos_turn(u.y);
    return {r * a.cos, r * a.sin, z};
}

/// Barycentrics (b1, b2) of a uniform point in a triangle.
/// Heitz, "A Low-Distortion Map Between Triangle and Square", 2019.
inline Vec2f warp_triangle(Vec2f u) {
    const float half = 0.5f * std::min(u.x, u.y);
    return {u.x - half, u.y - half};
}

/// Cone about +z with 1 - cos(half angle) = one_minus_cos; uniform density 1 / (2 pi
/// one_minus_cos).
inline Vec3f warp_cone(Vec2f u, float one_minus_cos) {
    const float k = u.x * one_minus_cos;  // 1 - cos(theta), without cancellation
    const float r = safe_sqrt(k * (2.0f - k));
    const SinCos a = sincos_turn(u.y);
    return {r * a.cos, r * a.sin, 1.0f - k};
}

/// Power heuristic with exponent 2. Veach, "Robust Monte Carlo Methods", 1997, eq. 9.13.
inline float mis_power(float pdf, float other) {
    if (pdf <= 0.0f) return 0.0f;
    const float r = other / pdf;
    return 1.0f / (1.0f + r * r);
}

}  // namespace tessera
