#include "materials/surface/surface.h"

#include <algorithm>

#include "materials/fresnel.h"

namespace tessera {
namespace {

// A rough coat widens what is seen through it. OpenPBR 1.1, "Coat", roughening.
float below_coat_roughness(const SurfaceParams& p) {
    const float b = p.specular_roughness, c = p.coat_roughness;
    const float widened =
        std::sqrt(std::sqrt(std::min(b * b * b * b + 2.0f * c * c * c * c, 1.0f)));
    return b + (widened - b) * p.coat_weight;
}

// Index of the base against what lies on it: air or coat.
float below_coat_ior(const SurfaceParams& p) {
    const float bare = p.specular_ior, coated = p.specular_ior / p.coat_ior;
    return bare + (std::max(coated, 1.0f / coated) - bare) * p.coat_weight;
}

// Mean Fresnel reflectance over the hemisphere, from outside, 1 < eta < 3.
// d'Eon, "A Hitchhiker's Guide to Multiple Scattering", 2016; OpenPBR 1.1, "Coat".
float mean_reflectance(float eta) {
    return std::log((10893.0f * eta - 1438.2f) / (-774.4f * eta * eta + 10212.0f * eta + 1.0f));
}

}  // namespace

Ggx openpbr_ggx(float roughness, float anisotropy) {
    const float alpha = roughness * roughness;
    if (anisotropy == 0.0f) return {alpha, alpha};
    const float a = 1.0f - anisotropy;
    const float ax = alpha * std::sqrt(2.0f / (1.0f + a * a));
    // One axis may go to zero, the density may not.
    return {std::max(ax, kMinAlpha), std::max(a * ax, kMinAlpha)};
}

Surface::Surface(const SurfaceParams& params) : p(params) {
    const bool coated = p.coat_weight > 0.0f;
    ggx = openpbr_ggx(coated ? below_coat_roughness(p) : p.specular_roughness,
                      p.specular_roughness_anisotropy);
    ior = modulated_ior(p.specular_ior, p.specular_weight);
    // Opaque bases look the same from both sides, so their boundary is always entered.
    const float opaque_ior = coated ? modulated_ior(below_coat_ior(p), p.specular_weight) : ior;
    boundary_eta = std::max(opaque_ior, 1.0f / opaque_ior);
    if (!coated) return;
    coat_ggx = openpbr_ggx(p.coat_roughness, p.coat_roughness_anisotropy);
    const float eta = std::clamp(p.coat_ior, 1.001f, 3.0f);
    coat_reflection = clamp01(1.0f - (1.0f - mean_reflectance(eta)) / (eta * eta));
    const Color diffuse =
        lerp(p.base_color * p.base_weight, p.subsurface_color, p.subsurface_weight);
    const Color dielectric = lerp(diffuse, p.transmission_color, p.transmission_weight);
    below_coat = lerp(dielectric, p.base_color * p.base_weight, p.base_metalness);
}

CurveKey Surface::curve_key() const {
    const auto flag = [](bool yes) { return yes ? 1.0f : 0.0f; };
    return {is_smooth(ggx) ? 0.0f : mean_alpha(ggx),
            boundary_eta,
            ior,
            flag(p.base_metalness > 0.0f),
            flag(p.base_metalness < 1.0f),
            flag(p.transmission_weight > 0.0f),
            flag(p.transmission_weight < 1.0f),
            flag(p.thin_walled),
            flag(p.coat_weight > 0.0f),
            is_smooth(coat_ggx) ? 0.0f : mean_alpha(coat_ggx),
            p.coat_ior};
}

SurfaceCurves Surface::make_curves() const {
    SurfaceCurves c;
    const bool dielectric = p.base_metalness < 1.0f;
    if (!is_smooth(ggx)) {
        const float alpha = mean_alpha(ggx);
        if (dielectric && p.transmission_weight < 1.0f && boundary_eta > 1.0f + kSameIndex)
            c.boundary = AlbedoCurve::dielectric(alpha, boundary_eta);
        if (p.base_metalness > 0.0f || (p.thin_walled && p.transmission_weight > 0.0f))
            c.metal = AlbedoCurve::mirror(alpha);
        if (dielectric && p.transmission_weight > 0.0f && !p.thin_walled) {
            c.glass_outside = AlbedoCurve::glass(alpha, ior);
            c.glass_inside = AlbedoCurve::glass(alpha, 1.0f / ior);
        }
    }
    if (p.coat_weight > 0.0f && !is_smooth(coat_ggx))
        c.coat = AlbedoCurve::dielectric(mean_alpha(coat_ggx), p.coat_ior);
    return c;
}

float Surface::varied_boundary_albedo(float cos_o) const {
    if (is_smooth(ggx)) return fresnel_dielectric(cos_o, boundary_eta);
    return dielectric_reflection_albedo(cos_o, mean_alpha(ggx), boundary_eta);
}

float Surface::metal_albedo(float cos_o) const {
    if (is_smooth(ggx) || is_stretched(ggx)) return 1.0f;
    if (curves && curves->metal) return (*curves->metal)(cos_o);
    return mirror_albedo(cos_o, mean_alpha(ggx));
}

float Surface::coat_albedo(float cos_o) const {
    if (is_smooth(coat_ggx)) return fresnel_dielectric(cos_o, p.coat_ior);
    if (curves && curves->coat) return (*curves->coat)(cos_o);
    return dielectric_reflection_albedo(cos_o, mean_alpha(coat_ggx), p.coat_ior);
}

float Surface::glass_albedo_for(float cos_o, float eta) const {
    if (is_stretched(ggx)) return 1.0f;
    if (curves && curves->glass_outside && eta == ior) return (*curves->glass_outside)(cos_o);
    if (curves && curves->glass_inside && eta == 1.0f / ior) return (*curves->glass_inside)(cos_o);
    return glass_albedo(cos_o, mean_alpha(ggx), eta);
}

}  // namespace tessera
