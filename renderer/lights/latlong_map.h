#pragma once
// Radiance by direction: a lat-long picture, y up, or the same from everywhere.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/core/fast_math.h"
#include "renderer/core/vec.h"

namespace tessera {

struct LatLongMap {
    int width = 0, height = 0;  // 0: constant
    std::vector<Color> texels;  // row 0 is up (+y)
    Color scale{1.0f};
    float cos_rotate = 1, sin_rotate = 0;  // about +y

    // The four texels around a point, and where it lies between them.
    struct Corners {
        std::int32_t i00, i01, i10, i11;
        float tx, ty;
    };

    /// u = 0.5 looks along -z, u grows toward +x; v = 0 is +y. d is a unit vector.
    Vec2f to_uv(Vec3f d) const {
        const float x = cos_rotate * d.x - sin_rotate * d.z,
                    z = sin_rotate * d.x + cos_rotate * d.z;
        return {0.5f + atan2_turn(x, -z), 2.0f * atan2_turn(std::sqrt(x * x + z * z), d.y)};
    }
    Vec3f to_direction(Vec2f uv) const {
        const SinCos phi = sincos_turn(uv.x), theta = sincos_turn(0.5f * uv.y);
        // phi is measured from u = 0, half a turn away from -z.
        const Vec3f w{-theta.sin * phi.sin, theta.cos, theta.sin * phi.cos};
        return {cos_rotate * w.x + sin_rotate * w.z, w.y, -sin_rotate * w.x + cos_rotate * w.z};
    }
    Corners corners(Vec2f uv) const {
        const float x = uv.x * static_cast<float>(width) - 0.5f,
                    y = uv.y * static_cast<float>(height) - 0.5f;
        // Lanes that nobody looks at may hold what they like, NaN too; uv of others lie in [0, 1].
        const float fx = std::max(-1.0f, std::min(std::floor(x), static_cast<float>(width - 1))),
                    fy = std::max(-1.0f, std::min(std::floor(y), static_cast<float>(height - 1)));
        const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
        const int x0 = ix < 0 ? ix + width : ix, x1 = ix + 1 >= width ? ix + 1 - width : ix + 1;
        const int y0 = iy < 0 ? 0 : iy, y1 = iy + 1 >= height ? height - 1 : iy + 1;
        return {y0 * width + x0, y0 * width + x1, y1 * width + x0, y1 * width + x1, x - fx, y - fy};
    }
    Color blend(const Corners& c) const {
        const auto at = [&](int i) { return texels[static_cast<std::size_t>(i)]; };
        return lerp(lerp(at(c.i00), at(c.i01), c.tx), lerp(at(c.i10), at(c.i11), c.tx), c.ty) *
               scale;
    }
    /// Bilinear, scaled. There must be texels.
    Color texel(Vec2f uv) const { return blend(corners(uv)); }
    /// Along the unit vector d.
    Color look(Vec3f d) const { return width == 0 ? scale : texel(to_uv(d)); }
    std::size_t bytes() const { return texels.capacity() * sizeof(Color); }
};

/// texels: width x height RGB from the top. Sanitised by the caller.
LatLongMap make_latlong_map(int width, int height, std::vector<Color> texels, Color scale,
                            double rotate_deg);

}  // namespace tessera
