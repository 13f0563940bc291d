#include "materials/nodes/color_math.h"

#include <cmath>

#include "materials/lobe.h"

namespace tessera {
namespace {

// Wyman, Sloan, Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions",
// JCGT 2(2), 2013.
double bump(double wave, double at, double left, double right) {
    const double t = (wave - at) * (wave < at ? left : right);
    return std::exp(-0.5 * t * t);
}

}  // namespace

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
    for (double nm = 380; nm <= 780; nm += 10) {
        const double radiance = std::pow(nm, -5.0) / std::expm1(1.438776877e7 / (nm * t));
        xyz +=
            Vec3d{
                1.056 * bump(nm, 599.8, 0.0264, 0.0323) + 0.362 * bump(nm, 442.0, 0.0624, 0.0374) -
                    0.065 * bump(nm, 501.1, 0.0490, 0.0382),
                0.821 * bump(nm, 568.8, 0.0213, 0.0247) + 0.286 * bump(nm, 530.9, 0.0613, 0.0322),
                1.217 * bump(nm, 437.0, 0.0845, 0.0278) + 0.681 * bump(nm, 459.0, 0.0385, 0.0725)} *
            radiance;
    }
    const Vec3d rgb{3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                    -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                    0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z};
    const Color c(max(rgb / xyz.y, Vec3d(0.0)));
    return c / luminance(c);
}

}  // namespace tessera
