#pragma once
// What the eye makes of light: the CIE 1931 observer, the primaries of Rec.709, black bodies.

#include "renderer/core/vec.h"

namespace tessera {

/// The rows from XYZ to linear Rec.709, white D65. IEC 61966-2-1.
inline constexpr Vec3d kXyzToRed{3.2404542, -1.5371385, -0.4985314},
    kXyzToGreen{-0.9692660, 1.8760108, 0.0415560}, kXyzToBlue{0.0556434, -0.2040259, 1.0572252};

/// Not clipped: colours outside of Rec.709 have negative channels.
constexpr Vec3d xyz_to_rec709(Vec3d xyz) {
    return {dot(xyz, kXyzToRed), dot(xyz, kXyzToGreen), dot(xyz, kXyzToBlue)};
}

/// The matching functions of the 2 degree observer at a wavelength. Wyman, Sloan, Shirley 2013,
/// listing 2: within 1% of the greatest value.
Vec3d cie_xyz(double nm) noexcept;

inline constexpr double kSecondRadiation_nm_K = 1.438776877e7;  // hc / k

/// Planck's law without its constants: nm^-5 / (exp(hc / (nm k T)) - 1).
double planck(double nm, double kelvin) noexcept;

}  // namespace tessera
