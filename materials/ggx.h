#pragma once
// The GGX distribution of microfacets, height-correlated Smith masking, sampling of the visible
// normals. Walter et al., "Microfacet Models for Refraction", EGSR 2007; Heitz, "Understanding the
// Masking-Shadowing Function", JCGT 3(2), 2014; Dupuy & Benyoub, "Sampling Visible GGX Normals with
// Spherical Caps", HPG 2023.

#include <cmath>

#include "renderer/core/fast_math.h"
#include "renderer/core/vec.h"

namespace tessera {

/// Below this alpha a surface is a mirror: D at its peak would exceed 1e5 and its square float's
/// comfort.
inline constexpr float kMinAlpha = 1e-3f;

struct Ggx {
    float ax = 1, ay = 1;

    float d(Vec3f h) const {
        const float a = h.x / ax, b = h.y / ay;
        const float k = a * a + b * b + h.z * h.z;
        return h.z > 0.0f ? 1.0f / (kPi * ax * ay * k * k) : 0.0f;
    }
    /// d(h / |h|) for an h of squared length l2, h.z > 0, by one division.
    float d_of(Vec3f h, float l2) const {
        const float a = h.x * ay, b = h.y * ax, c = h.z * (ax * ay);
        const float k = a * a + b * b + c * c, axy = ax * ay;
        return axy * axy * axy * l2 * l2 / (kPi * k * k);
    }
    /// w.z (1 + 2 lambda(w)): the length of w in the space where the microfacets are a hemisphere.
    float stretched(Vec3f w) const {
        const float a = w.x * ax, b = w.y * ay;
        return std::sqrt(w.z * w.z + a * a + b * b);
    }
    float lambda(Vec3f w) const {
        const float a = w.x * ax, b = w.y * ay;
        return 0.5f * (std::sqrt(1.0f + (a * a + b * b) / (w.z * w.z)) - 1.0f);
    }
    float g1(Vec3f w) const { return 1.0f / (1.0f + lambda(w)); }
    float g2(Vec3f wo, Vec3f wi) const { return 1.0f / (1.0f + lambda(wo) + lambda(wi)); }
    /// Density of the visible normals seen from wo.
    float visible(Vec3f wo, Vec3f h) const {
        return g1(wo) * std::max(0.0f, dot(wo, h)) * d(h) / wo.z;
    }

    Vec3f sample_visible(Vec3f wo, Vec2f u) const {
        const Vec3f w = normalize(Vec3f{wo.x * ax, wo.y * ay, wo.z});
        const SinCos a = sincos_turn(u.x);
        const float z = (1.0f - u.y) * (1.0f + w.z) - w.z;
        const float r = safe_sqrt(1.0f - z * z);
        const Vec3f h = Vec3f{r * a.cos, r * a.sin, z} + w;
        return normalize(Vec3f{h.x * ax, h.y * ay, std::max(1e-7f, h.z)});
    }
};

inline Vec3f reflect(Vec3f w, Vec3f n) { return n * (2.0f * dot(w, n)) - w; }

/// w refracted through n (dot(w, n) > 0); eta as in fresnel_dielectric, cos_t from it.
inline Vec3f refract(Vec3f w, Vec3f n, float eta, float cos_t) {
    return w * (-1.0f / eta) + n * (dot(w, n) / eta - cos_t);
}

}  // namespace tessera
