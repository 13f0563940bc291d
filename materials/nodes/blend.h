#pragma once
// How a layer lies on what is below it. Porter & Duff, "Compositing Digital Images", SIGGRAPH 1984;
// the modes of W3C "Compositing and Blending Level 1".

#include "renderer/core/vec.h"

namespace tessera {

/// Modes as the node `layer` numbers them; mask in [0, 1].
inline Color blended(Color below, Color above, float mask, int mode) {
    const auto one = [&](float b, float a) {
        switch (mode) {
            case 1:
                return a * b;
            case 2:
                return a + b - a * b;
            case 3:
                return b <= 0.5f ? 2.0f * a * b : 1.0f - 2.0f * (1.0f - a) * (1.0f - b);
            case 4:
                return b + a;
            case 5:
                return b - a;
            case 6:
                return std::max(a, b);
            case 7:
                return std::min(a, b);
            case 8: {
                if (a <= 0.5f) return b - (1.0f - 2.0f * a) * b * (1.0f - b);
                const float d = b <= 0.25f ? ((16.0f * b - 12.0f) * b + 4.0f) * b : safe_sqrt(b);
                return b + (2.0f * a - 1.0f) * (d - b);
            }
            default:
                return a;
        }
    };
    return lerp(below, Color{one(below.x, above.x), one(below.y, above.y), one(below.z, above.z)},
                mask);
}

}  // namespace tessera
