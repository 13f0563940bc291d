#include "materials/thin_film.h"

#include <cmath>

#include "renderer/core/cie.h"

namespace tessera {
namespace {

/// Amplitudes of reflection, signed, for the two polarisations.
struct Amplitudes {
    float s, p;
};

Amplitudes dielectric_amplitudes(float cos_i, float cos_t, float eta) {
    return {(cos_i - eta * cos_t) / (cos_i + eta * cos_t),
            (eta * cos_i - cos_t) / (eta * cos_i + cos_t)};
}

// The eye's sensitivities as Gaussians over wave numbers, transformed (Belcour & Barla 2017,
// supplemental): what is left of a fringe of the path difference `opd` (micrometres), as XYZ of
// which each is one for no difference.
Color fringe_xyz(float opd) {
    const double phase = 2.0 * 3.14159265358979 * static_cast<double>(opd) * 1e-6;
    const auto gauss = [&](double value, double position, double variance) {
        return value * std::sqrt(2.0 * 3.14159265358979 * variance) * std::cos(position * phase) *
               std::exp(-variance * phase * phase);
    };
    const double x = gauss(5.4856e-13, 1.6810e6, 4.3278e9) + gauss(9.7470e-14, 2.2399e6, 4.5282e9),
                 y = gauss(4.4201e-13, 1.7953e6, 9.3046e9),
                 z = gauss(5.2481e-13, 2.2084e6, 6.6121e9);
    constexpr double kNorm = 1.0 / 1.0685e-7;
    return Color(Vec3d{x * kNorm, y * kNorm, z * kNorm});
}

// XYZ to linear Rec.709 with each row scaled so that equal energy is white: a film that does
// nothing must not tint.
Color to_rgb(Color c) {
    const Vec3f r(kXyzToRed), g(kXyzToGreen), b(kXyzToBlue), one(1.0f);
    return {dot(r, c) / dot(r, one), dot(g, c) / dot(g, one), dot(b, c) / dot(b, one)};
}

// Airy's sum for one polarisation: r12 at the film's top, r23 below it.
Color airy(float r12, Color r23, Color (&fringe)[3]) {
    const float top = r12 * r12, through = 1.0f - top;
    Color sum, power(1.0f);
    const Color below = r23 * r23;
    const auto steady = [&](float b) { return through * through * b / (1.0f - top * b); };
    const Color rs{steady(below.x), steady(below.y), steady(below.z)};
    sum = Color(top) + rs;
    // -r12 is what the film's top reflects from below.
    const Color round = r23 * -r12;
    for (const Color& f : fringe) {
        power *= round;
        sum += (rs - Color(through)) * power * f * 2.0f;
    }
    return sum;
}

constexpr float kLeastFilm = 0.75f, kFilmFade = 0.6f;

}  // namespace

Color FilmFresnel::operator()(float cos_i) const {
    const Color plain = bare(cos_i);
    // A film thinner than what lies on it reflects all beyond its critical angle only if no wave
    // reaches through it. Towards that angle it is faded out, and it is not let be thinner still.
    const float index = std::max(film_eta, kLeastFilm);
    const float sin2_film = (1.0f - cos_i * cos_i) / (index * index);
    if (!(weight > 0.0f) || sin2_film >= 1.0f) return plain;
    const float cos_film = std::sqrt(1.0f - sin2_film);
    const Amplitudes top = dielectric_amplitudes(cos_i, cos_film, index);
    Color s, p;
    if (metal > 0.0f) {
        // A metal as a conductor of no phase of its own: its reflectance is kept, its colour too.
        const Color r{std::sqrt(plain.x), std::sqrt(plain.y), std::sqrt(plain.z)};
        s = -r, p = r;
    } else {
        const float sin2_below = (1.0f - cos_i * cos_i) / (eta * eta);
        if (sin2_below >= 1.0f) return plain;
        const Amplitudes below =
            dielectric_amplitudes(cos_film, std::sqrt(1.0f - sin2_below), eta / index);
        s = Color(below.s), p = Color(below.p);
    }
    const float opd = 2.0f * index * thickness * cos_film;
    Color fringe[3];
    for (int m = 1; m <= 3; ++m) fringe[m - 1] = to_rgb(fringe_xyz(opd * static_cast<float>(m)));
    const Color film = (airy(top.s, s, fringe) + airy(top.p, p, fringe)) * 0.5f;
    const Color bounded = min(max(film, Color(0.0f)), Color(1.0f));
    const float near = index < 1.0f ? std::min(cos_film * (1.0f / kFilmFade), 1.0f) : 1.0f;
    return lerp(plain, bounded, weight * near * near * (3.0f - 2.0f * near));
}

}  // namespace tessera
