#include "materials/dispersion.h"

#include "renderer/core/cie.h"

namespace tessera {
namespace {

// Linear Rec.709 of a wavelength; what lies outside the gamut is cut off.
Vec3d rgb(double nm) { return max(xyz_to_rec709(cie_xyz(nm)), Vec3d(0.0)); }

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
