#pragma once
// Rays that leave a surface without hitting it: the origin is moved by a bound on the rounding
// error. Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., section 6.8; the bounds
// there cover the position. kSafety widens them for the rounding inside Embree's robust triangle
// test and its instance transform (measured by tests/unit/self_hit_test.cpp).

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "renderer/core/affine.h"
#include "renderer/core/vec.h"

namespace tessera {

inline constexpr float kEpsilonHalf = std::numeric_limits<float>::epsilon() * 0.5f;

/// Bound on the relative error of n rounded operations.
constexpr float gamma_bound(int n) {
    const float e = static_cast<float>(n) * kEpsilonHalf;
    return e / (1.0f - e);
}

inline constexpr float kSafety = 2.0f;

/// Error of a point that a map takes from its shape's space into the scene's (PBRT 4e, eq. 6.29
/// ff). Embree takes the ray into the shape's space; what it rounds there comes back grown by the
/// map's condition.
inline Vec3f error_in_place(const Affinef& m, float condition, Vec3f p, Vec3f error) {
    const Vec3f magnitude = abs(m.x) * std::fabs(p.x) + abs(m.y) * std::fabs(p.y) +
                            abs(m.z) * std::fabs(p.z) + abs(m.p);
    const Vec3f carried = abs(m.x) * error.x + abs(m.y) * error.y + abs(m.z) * error.z;
    return carried * (1.0f + gamma_bound(3)) + magnitude * gamma_bound(4) +
           Vec3f(max_component(magnitude) * condition * gamma_bound(2));
}

/// Next float away from (up) or toward negative infinity. Finite input, not NaN.
inline float next_up(float v) {
    if (v == 0.0f) return std::numeric_limits<float>::min();  // denormals are flushed
    const auto bits = std::bit_cast<std::uint32_t>(v);
    return std::bit_cast<float>(v > 0.0f ? bits + 1 : bits - 1);
}
inline float next_down(float v) { return -next_up(-v); }

/// p moved off the surface along +-ng to the side w points to. error: bound per axis.
inline Vec3f offset_origin(Vec3f p, Vec3f error, Vec3f ng, Vec3f w) {
    const float d = dot(abs(ng), error) * kSafety;
    const Vec3f offset = dot(w, ng) < 0.0f ? ng * -d : ng * d;
    const Vec3f q = p + offset;
    const auto away = [](float value, float o) {
        return o > 0.0f ? next_up(value) : (o < 0.0f ? next_down(value) : value);
    };
    return {away(q.x, offset.x), away(q.y, offset.y), away(q.z, offset.z)};
}

/// What Debian's Embree accepts without aborting: finite, and below its 1.844e18 limit with room to
/// spare.
inline bool traceable(Vec3f o, Vec3f d) {
    constexpr float kLimit = 1e18f;
    // A sum, not a maximum: it hands a NaN on.
    const float m = (std::abs(o.x) + std::abs(o.y) + std::abs(o.z)) +
                    (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    return m <= kLimit && length2(d) > 0.0f;
}

}  // namespace tessera
