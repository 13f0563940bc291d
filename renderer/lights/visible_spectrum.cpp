#include "renderer/lights/visible_spectrum.h"

namespace tessera {
namespace {

// A bell with a width for each side.
double lobe(double nm, double peak, double middle, double below, double above) {
    const double t = (nm - middle) / (nm < middle ? below : above);
    return peak * std::exp(-0.5 * t * t);
}

// Wyman, Sloan, Shirley, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions",
// JCGT 2(2), 2013, eq. 4.
Vec3d matching(double nm) {
    return {lobe(nm, 1.056, 599.8, 37.9, 31.0) + lobe(nm, 0.362, 442.0, 16.0, 26.7) +
                lobe(nm, -0.065, 501.1, 20.4, 26.2),
            lobe(nm, 0.821, 568.8, 46.9, 40.5) + lobe(nm, 0.286, 530.9, 16.3, 31.1),
            lobe(nm, 1.217, 437.0, 11.8, 36.0) + lobe(nm, 0.681, 459.0, 26.0, 13.8)};
}

// IEC 61966-2-1, from XYZ of white D65.
Vec3d rec709(Vec3d xyz) {
    return {dot(xyz, {3.2404542, -1.5371385, -0.4985314}),
            dot(xyz, {-0.9692660, 1.8760108, 0.0415560}),
            dot(xyz, {0.0556434, -0.2040259, 1.0572252})};
}

// Each band's share of the matching functions, finely summed: the bands are as wide as the lobes'
// flanks.
struct Observer {
    Vec3d rgb[kWavelengths];

    Observer() {
        constexpr int kFine = 16;
        double seen = 0;
        Vec3d xyz[kWavelengths];
        for (int i = 0; i < kWavelengths; ++i) {
            for (int k = 0; k < kFine; ++k)
                xyz[i] += matching(kShortest_nm + (i + (k + 0.5) / kFine) * kBand_nm);
            seen += xyz[i].y;
        }
        for (int i = 0; i < kWavelengths; ++i)
            rgb[i] = rec709(xyz[i] * ((kLongest_nm - kShortest_nm) / seen));
    }
};

// Planck's law without its constants, x = hc / (lambda k T).
double planck(double nm, double kelvin) {
    constexpr double kSecondRadiation = 1.438776877e7;  // hc / k, nm K
    return std::pow(nm, -5) / std::expm1(kSecondRadiation / (nm * kelvin));
}

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

Spectrum sunlight() {
    constexpr double kKelvin = 5778, kTotal = 1361, kPi4 = 97.40909103400244,
                     kSecondRadiation = 1.438776877e7;
    // The integral of planck() over all wavelengths: (T k / hc)^4 pi^4 / 15.
    const double all = std::pow(kKelvin / kSecondRadiation, 4) * kPi4 / 15;
    return Spectrum::map([&](int i) {
        return static_cast<float>(kTotal * planck(wavelength_nm(i), kKelvin) / all);
    });
}

Color to_rgb(const Spectrum& per_nm) {
    static const Observer observer;
    Vec3d c;
    for (int i = 0; i < kWavelengths; ++i) c += observer.rgb[i] * static_cast<double>(per_nm[i]);
    const double grey = dot(c, {0.2126, 0.7152, 0.0722}), least = min_component(c);
    if (!(grey > 0)) return Color(0.0f);
    if (least < 0) c = Vec3d(grey) + (c - Vec3d(grey)) * (grey / (grey - least));
    return Color(max(c, Vec3d(0.0)));
}

Spectrum reflectance_spectrum(Color rgb) {
    return Spectrum::map([&](int i) {
        const double nm = wavelength_nm(i);
        const auto past_blue = static_cast<float>(smooth_step(475, 505, nm)),
                   past_green = static_cast<float>(smooth_step(565, 595, nm));
        return rgb.z * (1.0f - past_blue) + rgb.y * past_blue * (1.0f - past_green) +
               rgb.x * past_green;
    });
}

}  // namespace tessera
