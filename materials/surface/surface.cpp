#include "materials/surface/surface.h"

#include <algorithm>

#include "materials/fresnel.h"
#include "materials/lobes/fuzz.h"

namespace tessera {
namespace {

float mix(float a, float b, float t) { return a + (b - a) * t; }

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

// Index around what lies below the coat.
float around_base(float covering, float weight) {
    return 1.0f / mix(1.0f, 1.0f / covering, weight);
}

// Mean Fresnel reflectance over the hemisphere, from outside, 1 < eta < 3.
// d'Eon, "A Hitchhiker's Guide to Multiple Scattering", 2016; OpenPBR 1.1, "Coat".
float mean_reflectance(float eta) {
    return std::log((10893.0f * eta - 1438.2f) / (-774.4f * eta * eta + 10212.0f * eta + 1.0f));
}

// Mean of 1 / cosine after refraction, of light from all around: the cosine-weighted integral of
// 1 / sqrt(1 - (1 - mu^2) / eta^2).
float mean_way(float eta) {
    const float e2 = std::max(eta * eta, 1.0f);
    return 2.0f / (1.0f + safe_sqrt(1.0f - 1.0f / e2));
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
    if (p.thin_film_weight > 0.0f) lay_film();
    if (coated) look_below_coat();
}

void Surface::lay_film() {
    film_outside = around_base(p.coat_ior, p.coat_weight);
    // A base thinner than its coat is looked at from its own side: boundary_eta is at least one.
    const float thinner = std::min(p.coat_ior, p.specular_ior);
    boundary_film = film_on(boundary_eta, around_base(thinner, p.coat_weight));
    const bool opaque = p.base_metalness < 1.0f && p.transmission_weight < 1.0f;
    if (is_smooth(ggx) || !opaque) return;
    for (int i = 0; i < kFresnelNodes; ++i)
        film_nodes[static_cast<std::size_t>(i)] = boundary_film(fresnel_node(i));
}

// OpenPBR 1.1, "Coat", darkening: r_b, E_b, K_r.
void Surface::look_below_coat() {
    coat_ggx = openpbr_ggx(p.coat_roughness, p.coat_roughness_anisotropy);
    // From within a coat thinner than air it is the other side's mean, by reciprocity.
    const float eta = std::max({p.coat_ior, 1.0f / p.coat_ior, 1.001f});
    const float outside = mean_reflectance(std::min(eta, 3.0f));
    coat_reflection = p.coat_ior < 1.0f ? outside : clamp01(1.0f - (1.0f - outside) / (eta * eta));
    coat_way = mean_way(p.coat_ior);
    const float r = p.specular_roughness, f0 = fresnel_dielectric(1.0f, boundary_eta);
    const float dielectric_spread = mix(mix(1.0f, r, f0), r, p.transmission_weight);
    coat_spread = mix(dielectric_spread, r, p.base_metalness);
    const Color specular = p.specular_color * f0;
    const Color body = lerp(p.base_color * p.base_weight, p.subsurface_color, p.subsurface_weight);
    const Color opaque = specular + (Color(1.0f) - specular) * body;
    const Color dielectric = lerp(opaque, p.transmission_color, p.transmission_weight);
    const Color metal = p.base_color * (p.base_weight * std::min(p.specular_weight, 1.0f));
    below_coat = lerp(dielectric, metal, p.base_metalness);
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

FilmFresnel Surface::film_on(float eta, float outside) const {
    FilmFresnel f;
    f.eta = eta;
    f.film_eta = p.thin_film_ior / outside;
    f.thickness = p.thin_film_thickness;
    f.weight = p.thin_film_weight;
    return f;
}

Color Surface::film_albedo(float cos_o) const {
    if (is_smooth(ggx)) return boundary_film(cos_o);
    const float alpha = mean_alpha(ggx);
    const FresnelWeights lobe = fresnel_weights(cos_o, alpha), here = fresnel_interpolation(cos_o);
    Color sum(0.0f), interpolated(0.0f);
    float all = 0;
    for (std::size_t i = 0; i < film_nodes.size(); ++i) {
        sum += film_nodes[i] * lobe[i];
        interpolated += film_nodes[i] * here[i];
        all += lobe[i];
    }
    // The narrower the lobe, the more of it sees what the curve is between its nodes.
    const Color missed = (boundary_film(cos_o) - interpolated) * (all * sqr(1.0f - alpha));
    return min(max(sum + missed, Color(0.0f)), Color(1.0f));
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

// OpenPBR 1.1, "Emission": it passes the coat once, so that a straight way takes coat_color's root.
Color Surface::covering(float cos_o, bool front) const {
    if (!front && p.transmission_weight > 0.0f && p.base_metalness < 1.0f) return Color(1.0f);
    const float mu = std::max(cos_o, 1e-4f);
    const float fuzz =
        p.fuzz_weight > 0.0f ? FuzzLobe::seen_at(mu, p.fuzz_roughness).reflectance : 0.0f;
    const Color passes(1.0f - p.fuzz_weight * fuzz);
    if (!(p.coat_weight > 0.0f)) return passes;
    const float way = 0.5f / std::max(refracted_cosine(mu, p.coat_ior), 1e-3f);
    const Color tint{std::pow(p.coat_color.x, way), std::pow(p.coat_color.y, way),
                     std::pow(p.coat_color.z, way)};
    return passes * lerp(Color(1.0f), tint * (1.0f - coat_albedo(mu)), p.coat_weight);
}

float Surface::glass_albedo_for(float cos_o, float eta) const {
    if (is_stretched(ggx)) return 1.0f;
    if (curves && curves->glass_outside && eta == ior) return (*curves->glass_outside)(cos_o);
    if (curves && curves->glass_inside && eta == 1.0f / ior) return (*curves->glass_inside)(cos_o);
    return glass_albedo(cos_o, mean_alpha(ggx), eta);
}

}  // namespace tessera
