#pragma once
// Light at a few wavelengths, and the colour it has.
// An RGB triple counts visible watts: light of equal power at every wavelength from 380 to 720 nm
// has the luminance (0.2126 R + 0.7152 G + 0.0722 B) of its power within that band; other spectra
// are weighted by the CIE 1931 curve of the eye. One such watt is 683 lm/W * 106.9 nm / 340 nm =
// 215 lm.

#include <bit>
#include <cmath>
#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

inline constexpr int kWavelengths = 16;
inline constexpr double kShortest_nm = 380, kLongest_nm = 720;
inline constexpr double kBand_nm = (kLongest_nm - kShortest_nm) / kWavelengths;

/// The middle of each band.
constexpr double wavelength_nm(int i) { return kShortest_nm + (i + 0.5) * kBand_nm; }

/// Values per nm, one for each band. All loops over them are vectorised.
struct Spectrum {
    alignas(32) float v[kWavelengths];

    Spectrum() = default;
    explicit Spectrum(float s) {
        for (float& x : v) x = s;
    }
    float operator[](int i) const { return v[i]; }
    Spectrum operator+(const Spectrum& b) const {
        return map([&](int i) { return v[i] + b.v[i]; });
    }
    Spectrum operator-(const Spectrum& b) const {
        return map([&](int i) { return v[i] - b.v[i]; });
    }
    Spectrum operator*(const Spectrum& b) const {
        return map([&](int i) { return v[i] * b.v[i]; });
    }
    Spectrum operator/(const Spectrum& b) const {
        return map([&](int i) { return v[i] / b.v[i]; });
    }
    Spectrum operator*(float s) const {
        return map([&](int i) { return v[i] * s; });
    }
    Spectrum& operator+=(const Spectrum& b) { return *this = *this + b; }
    Spectrum& operator*=(const Spectrum& b) { return *this = *this * b; }

    /// f(i) of every band.
    template <class F>
    static Spectrum map(F f) {
        Spectrum out;
        for (int i = 0; i < kWavelengths; ++i) out.v[i] = f(i);
        return out;
    }
};

inline Spectrum lerp(const Spectrum& a, const Spectrum& b, float t) {
    return a * (1.0f - t) + b * t;
}

/// exp(-x), x >= 0; relative error below 1e-6, 0 for what float cannot hold.
inline Spectrum exp_minus(const Spectrum& x) {
    return Spectrum::map([&](int i) {
        const float t = std::max(x.v[i] * -1.44269504f, -126.0f), whole = std::floor(t);
        const float y = (t - whole) * 0.693147181f;
        // Taylor: y < 0.694.
        const float e =
            1.0f +
            y * (1.0f +
                 y * (0.5f + y * (1.66666667e-1f +
                                  y * (4.16666667e-2f +
                                       y * (8.33333333e-3f +
                                            y * (1.38888889e-3f +
                                                 y * (1.98412698e-4f + y * 2.48015873e-5f)))))));
        const auto power = static_cast<std::int32_t>(whole) + 127;
        return t > -126.0f ? e * std::bit_cast<float>(power << 23) : 0.0f;
    });
}

/// Irradiance outside the atmosphere facing the sun at its mean distance, W/m^2/nm: a black body of
/// 5778 K that sends 1361 W/m^2 in all (Kopp & Lean, "A new, lower value of total solar
/// irradiance", Geophys. Res. Lett. 38, 2011).
Spectrum sunlight();

/// The colour of a spectral radiance (or irradiance) in linear Rec.709, not adapted to any white.
/// Colours too pure for Rec.709 are mixed with grey of their luminance until no channel is
/// negative.
Color to_rgb(const Spectrum& per_nm);

/// A reflectance in [0,1] at all wavelengths: red, green and blue have a third each and are blended
/// at 490 and 580 nm.
Spectrum reflectance_spectrum(Color rgb);

}  // namespace tessera
