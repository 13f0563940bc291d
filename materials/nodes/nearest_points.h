#pragma once
// Points strewn over the lattice, one into each cell, and the two of them that lie nearest.

#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

/// The two nearest points; where they lie relative to p, and the hashes of their cells.
struct NearestPoints {
    float d1 = kInfinity, d2 = kInfinity;  // squared distances
    float d3 = kInfinity;                  // that of the third, for nearest_three
    Vec3f at1, at2;
    std::uint32_t id1 = 0, id2 = 0;

    void add(Vec3f at, std::uint32_t id) noexcept {
        const float d = length2(at);
        if (d < d1) {
            d3 = d2, d2 = d1, at2 = at1, id2 = id1;
            d1 = d, at1 = at, id1 = id;
        } else if (d < d2) {
            d3 = d2, d2 = d, at2 = at, id2 = id;
        } else {
            d3 = std::min(d3, d);
        }
    }

    /// The nearest point's share of a footprint of side w > 0 that reaches over the border, which
    /// lies half way between the two; at least a half.
    float own_share(float w) const noexcept {
        const float apart = length(at2 - at1);
        const float inside = apart > 0.0f ? 0.5f * (d2 - d1) / apart : 0.0f;
        return std::min(0.5f + inside / w, 1.0f);
    }
};

/// p is not NaN; jitter in [0, 1], with 0 the points are the cells' centres.
NearestPoints nearest_points(Vec2f p, float jitter) noexcept;
NearestPoints nearest_points(Vec3f p, float jitter) noexcept;
/// With d3 as well.
NearestPoints nearest_three(Vec2f p, float jitter) noexcept;
NearestPoints nearest_three(Vec3f p, float jitter) noexcept;

}  // namespace tessera
