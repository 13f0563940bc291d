#pragma once
// Reflectance at a smooth boundary.

#include <algorithm>
#include <cmath>

#include "renderer/core/vec.h"

namespace tessera {

/// Cosine on the far side of a boundary; 0 under total internal reflection.
inline float refracted_cosine(float cos_i, float eta) {
    return safe_sqrt(1.0f - (1.0f - cos_i * cos_i) / (eta * eta));
}

/// Unpolarised dielectric. cos_i >= 0: cosine on the incident side; eta: index beyond over index
/// here. Returns 1 under total internal reflection.
/// Born & Wolf, "Principles of Optics", section 1.5.2.
inline float fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = (1.0f - cos_i * cos_i) / (eta * eta);
    const float cos_t = safe_sqrt(1.0f - sin2_t);
    // Both polarisations over one denominator.
    const float s = cos_i + eta * cos_t, p = eta * cos_i + cos_t;
    const float rs = (cos_i - eta * cos_t) * p, rp = (eta * cos_i - cos_t) * s;
    const float partly = 0.5f * (rs * rs + rp * rp) / (s * s * p * p);
    return sin2_t < 1.0f ? partly : 1.0f;
}

constexpr float pow5(float x) { return x * x * x * x * x; }

/// Metal by its colour at normal incidence (f0) and at 82 degrees relative to Schlick's curve
/// (f82). Kutz, Hasan, Edmondson, "Novel Aspects of the Adobe Standard Material", 2021;
/// OpenPBR 1.1, "Metal".
inline Color fresnel_f82(Color f0, Color f82, float cos_i) {
    constexpr float kMu = 1.0f / 7.0f;
    constexpr float kMuTerm =
        kMu * (1 - kMu) * (1 - kMu) * (1 - kMu) * (1 - kMu) * (1 - kMu) * (1 - kMu);
    constexpr float kMuSchlick = (1 - kMu) * (1 - kMu) * (1 - kMu) * (1 - kMu) * (1 - kMu);
    const Color white(1.0f);
    const Color schlick = f0 + (white - f0) * pow5(1.0f - cos_i);
    const Color at_mu = f0 + (white - f0) * kMuSchlick;
    const float c1 = 1.0f - cos_i;
    const Color f = schlick - at_mu * (white - f82) * (cos_i * c1 * pow5(c1) * (1.0f / kMuTerm));
    return {f.x > 0.0f ? f.x : 0.0f, f.y > 0.0f ? f.y : 0.0f, f.z > 0.0f ? f.z : 0.0f};
}

/// OpenPBR's specular_weight scales the reflectance at normal incidence and, above 1, the index
/// with it: returns the index whose F0 is weight times that of ior. OpenPBR 1.1, "Dielectric base".
/// Within [1 / kMostIor, kMostIor]: all that tables and curves are made for.
inline constexpr float kMostIor = 100;
inline float modulated_ior(float ior, float weight) {
    ior = std::min(std::max(ior, 1.0f / kMostIor), kMostIor);
    if (weight == 1.0f) return ior;
    constexpr float kMostF0 = sqr((kMostIor - 1.0f) / (kMostIor + 1.0f));
    const float r = (ior - 1.0f) / (ior + 1.0f);
    const float f0 = std::min(weight * r * r, kMostF0);
    const float e = std::copysign(std::sqrt(f0), r);
    return (1.0f + e) / (1.0f - e);
}

}  // namespace tessera
