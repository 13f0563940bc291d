#include "renderer/core/cie.h"

#include <cmath>

namespace tessera {
namespace {

// A bell with a slope (one over its width) on each side.
double bell(double nm, double peak, double middle, double below, double above) {
    const double t = (nm - middle) * (nm < middle ? below : above);
    return peak * std::exp(-0.5 * t * t);
}

}  // namespace

Vec3d cie_xyz(double nm) noexcept {
    return {bell(nm, 1.056, 599.8, 0.0264, 0.0323) + bell(nm, 0.362, 442.0, 0.0624, 0.0374) +
                bell(nm, -0.065, 501.1, 0.0490, 0.0382),
            bell(nm, 0.821, 568.8, 0.0213, 0.0247) + bell(nm, 0.286, 530.9, 0.0613, 0.0322),
            bell(nm, 1.217, 437.0, 0.0845, 0.0278) + bell(nm, 0.681, 459.0, 0.0385, 0.0725)};
}

double planck(double nm, double kelvin) noexcept {
    return std::pow(nm, -5.0) / std::expm1(kSecondRadiation_nm_K / (nm * kelvin));
}

}  // namespace tessera
