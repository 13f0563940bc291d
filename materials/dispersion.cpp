#include "materials/dispersion.h"

#include <cmath>

namespace tessera {
namespace {

// Colour matching as piecewise Gaussians: Wyman, Sloan, Shirley, "Simple Analytic Approximations to
// the CIE XYZ Color Matching Functions", JCGT 2(2), 2013.
double bump(double wave, double at, double left, double right) {
    const double t = (wave - at) * (wave < at ? left : right);
    return std::exp(-0.5 * t * t);
}

Vec3d xyz(double nm) {
    return {1.056 * bump(nm, 599.8, 0.0264, 0.0323) + 0.362 * bump(nm, 442.0, 0.0624, 0.0374) -
                0.065 * bump(nm, 501.1, 0.0490, 0.0382),
            0.821 * bump(nm, 568.8, 0.0213, 0.0247) + 0.286 * bump(nm, 530.9, 0.0613, 0.0322),
            1.217 * bump(nm, 437.0, 0.0845, 0.0278) + 0.681 * bump(nm, 459.0, 0.0385, 0.0725)};
}

// Linear Rec.709 of a wavelength; what lies outside the gamut is cut off.
Vec3d rgb(double nm) {
    const Vec3d c = xyz(nm);
    return max(Vec3d{3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
                     -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
                     0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z},
               Vec3d(0.0));
}

Vec3d mean_rgb() {
    constexpr int kSteps = 600;
    Vec3d sum;
    for (int i = 0; i < kSteps; ++i) {
        const double t = (i + 0.5) / kSteps;
        sum += rgb(1000.0 * (static_cast<double>(kShortestWave) +
                             t * static_cast<double>(kLongestWave - kShortestWave)));
    }
    return sum / static_cast<double>(kSteps);
}

}  // namespace

Color wave_response(float wave) {
    static const Vec3d mean = mean_rgb();
    const Vec3d c = rgb(1000.0 * static_cast<double>(wave));
    return Color(Vec3d{c.x / mean.x, c.y / mean.y, c.z / mean.z});
}

}  // namespace tessera
