#pragma once
// The pixel filter, importance-sampled: a sample is placed around its own pixel with the filter's
// density and then counts 1 there, so that no sample touches two pixels. Ernst, Stamminger,
// Greiner, "Filter Importance Sampling", IEEE Symposium on Interactive Ray Tracing 2006.

#include <array>

#include "renderer/api/scene_desc.h"
#include "renderer/core/vec.h"

namespace tessera {

class FilterSampler {
public:
    /// width: full width of the support in pixels.
    FilterSampler(PixelFilter filter, double width);
    /// u in [0,1)^2 to an offset from the pixel's centre, in pixels.
    Vec2f offset(Vec2f u) const noexcept { return {along(u.x), along(u.y)}; }

private:
    static constexpr int kSteps = 256;
    float along(float u) const noexcept {
        const float p = u * kSteps;
        const int i = static_cast<int>(p);
        return inverse_[i] + (inverse_[i + 1] - inverse_[i]) * (p - static_cast<float>(i));
    }
    std::array<float, kSteps + 1> inverse_{};  // inverse of the cumulative filter, in pixels
};

}  // namespace tessera
