#include "renderer/lights/visible_spectrum.h"

#include "renderer/core/cie.h"

namespace tessera {
namespace {

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
                xyz[i] += cie_xyz(kShortest_nm + (i + (k + 0.5) / kFine) * kBand_nm);
            seen += xyz[i].y;
        }
        for (int i = 0; i < kWavelengths; ++i)
            rgb[i] = xyz_to_rec709(xyz[i] * ((kLongest_nm - kShortest_nm) / seen));
    }
};

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

}  // namespace

Spectrum sunlight() {
    constexpr double kKelvin = 5778, kTotal = 1361, kPi4 = 97.40909103400244;
    // The integral of planck() over all wavelengths: (T k / hc)^4 pi^4 / 15.
    const double all = std::pow(kKelvin / kSecondRadiation_nm_K, 4) * kPi4 / 15;
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
