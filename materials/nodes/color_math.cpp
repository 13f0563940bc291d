#include "materials/nodes/color_math.h"

#include <cmath>

#include "materials/lobe.h"
#include "renderer/core/cie.h"

namespace tessera {
Vec3f rgb_to_hsv(Color c) {
    const float most = max_component(c), span = most - min_component(c);
    if (!(span > 0.0f)) return {0.0f, 0.0f, most};
    float hue = 0;
    if (c.x == most)
        hue = (c.y - c.z) / span;
    else if (c.y == most)
        hue = 2.0f + (c.z - c.x) / span;
    else
        hue = 4.0f + (c.x - c.y) / span;
    hue *= 1.0f / 6.0f;
    return {hue - std::floor(hue), most != 0.0f ? span / most : 0.0f, most};
}

Color hsv_to_rgb(Vec3f hsv) {
    const auto channel = [&](float n) {
        const float turns = hsv.x + n * (1.0f / 6.0f);
        const float k = 6.0f * (turns - std::floor(turns));
        const float t = std::min(k, 4.0f - k);
        return hsv.z - hsv.z * hsv.y * clamp01(t);
    };
    return {channel(5), channel(3), channel(1)};
}

Color blackbody_color(float kelvin) {
    const double t = static_cast<double>(kelvin > 800.0f ? std::min(kelvin, 25000.0f) : 800.0f);
    Vec3d xyz;
    for (double nm = 380; nm <= 780; nm += 10) xyz += cie_xyz(nm) * planck(nm, t);
    const Vec3d rgb = xyz_to_rec709(xyz);
    const Color c(max(rgb / xyz.y, Vec3d(0.0)));
    return c / luminance(c);
}

}  // namespace tessera
