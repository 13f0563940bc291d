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

/// The float next to v on the side that `toward` is on; v itself for 0. Finite input, else any
/// float: lanes that nobody looks at may hold what they like. Branch-free: the sides are random.
inline float next_toward_sign(float v, float toward) {
    const auto bits = std::bit_cast<std::uint32_t>(v);
    const auto outward = static_cast<std::int32_t>(bits ^ std::bit_cast<std::uint32_t>(toward));
    const float moved = std::bit_cast<float>(bits + (outward >= 0 ? 1u : ~0u));  // 1 up or down
    const float from_zero = std::copysign(std::numeric_limits<float>::min(), toward);
    const float next = v == 0.0f ? from_zero : moved;  // denormals are flushed
    return toward == 0.0f ? v : next;
}

/// p moved off the surface along +-ng to the side w points to. error: bound per axis.
inline Vec3f offset_origin(Vec3f p, Vec3f error, Vec3f ng, Vec3f w) {
    const float d = std::copysign(dot(abs(ng), error) * kSafety, dot(w, ng));
    const Vec3f offset = ng * d, q = p + offset;
    return {next_toward_sign(q.x, offset.x), next_toward_sign(q.y, offset.y),
            next_toward_sign(q.z, offset.z)};
}

/// What Debian's Embree accepts without aborting: finite, and below its 1.844e18 limit with room to
/// spare.
inline bool traceable(Vec3f o, Vec3f d) {
    constexpr float kLimit = 1e18f;
    // A sum, not a maximum: it hands a NaN on.
    const float m = std::abs(o.x) + std::abs(o.y) + std::abs(o.z), l2 = length2(d);
    return bool(int(m <= kLimit) & int(l2 > 0.0f) & int(l2 <= kLimit * kLimit));
}

}  // namespace tessera
