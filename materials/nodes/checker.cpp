#include "materials/nodes/box_filter.h"
#include "materials/nodes/pattern.h"

namespace tessera {
namespace {

// Mean of the square wave that is +1 in even cells and -1 in odd ones.
float square_mean(float x, float w) {
    return 2.0f * pulse_mean(0.5f * x, 0.5f * w, 0.0f, 0.5f) - 1.0f;
}

}  // namespace

Color checkerboard(Vec2f uv, const CheckerParams& c, float width) noexcept {
    const Vec2f at = coordinate(uv), tiling = coordinate(c.uvtiling),
                offset = coordinate(c.uvoffset);
    const float w = footprint(width);
    const float x = square_mean(coordinate(at.x * tiling.x - offset.x), w * std::fabs(tiling.x));
    const float y = square_mean(coordinate(at.y * tiling.y - offset.y), w * std::fabs(tiling.y));
    return lerp(c.color1, c.color2, 0.5f + 0.5f * x * y);
}

}  // namespace tessera
