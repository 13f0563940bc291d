#include "renderer/core/cie.h"

#include <doctest/doctest.h>

using namespace tessera;

// The CIE's table: the fit is within 1% of the greatest value, 1.78 for z.
TEST_CASE("cie: the matching functions peak where the observer's do") {
    CHECK(cie_xyz(555).y == doctest::Approx(1.0).epsilon(0.01));
    CHECK(cie_xyz(600).x == doctest::Approx(1.0622).epsilon(0.01));
    CHECK(cie_xyz(450).z == doctest::Approx(1.7721).epsilon(0.01));
    CHECK(cie_xyz(700).z < 1e-3);
    CHECK(cie_xyz(350).y < 2e-3);
}

TEST_CASE("cie: D65 is white in Rec.709") {
    const Vec3d white = xyz_to_rec709({0.95047, 1.0, 1.08883});
    // The matrix is given to seven digits.
    for (int i = 0; i < 3; ++i) CHECK(white[i] == doctest::Approx(1.0).epsilon(1e-4));
}

TEST_CASE("cie: a black body is brightest where Wien's law says") {
    for (const double kelvin : {2000.0, 5778.0, 12000.0}) {
        const double peak = 2.897771955e6 / kelvin;
        CHECK(planck(peak, kelvin) > planck(1.02 * peak, kelvin));
        CHECK(planck(peak, kelvin) > planck(0.98 * peak, kelvin));
    }
}
