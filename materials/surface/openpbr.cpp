#include "materials/surface/openpbr.h"

#include <algorithm>

#include "materials/energy.h"

namespace tessera {
namespace {

template <class Fresnel>
void push_reflection(LobeList& lobes, const Ggx& ggx, const Fresnel& fresnel, Color weight,
                     Color albedo) {
    if (std::max(ggx.ax, ggx.ay) < kMinAlpha) {
        lobes.push(SmoothReflection<Fresnel>{fresnel}, weight);
    } else {
        lobes.push(RoughReflection<Fresnel>{ggx, fresnel, albedo}, weight);
    }
}

// A boundary is looked through undisturbed where the two indices agree; the half vector is
// undefined there.
constexpr float kSameIndex = 1e-4f;

void push_transmission(LobeList& lobes, const SurfaceParams& p, const Ggx& ggx, float ior,
                       bool front, Color weight) {
    if (p.thin_walled) {
        lobes.push(ThinGlass{ior, p.specular_color, p.transmission_color}, weight);
        return;
    }
    const float eta = front ? ior : 1.0f / ior;
    if (std::max(ggx.ax, ggx.ay) < kMinAlpha || std::fabs(ior - 1.0f) < kSameIndex) {
        lobes.push(SmoothGlass{eta, p.specular_color, p.transmission_color}, weight);
    } else {
        lobes.push(RoughGlass{ggx, eta, p.specular_color, p.transmission_color}, weight);
    }
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

float openpbr_boundary_eta(const SurfaceParams& p) {
    // Opaque bases look the same from both sides, so their boundary is always entered.
    const float ior = modulated_ior(p.specular_ior, p.specular_weight);
    return std::max(ior, 1.0f / ior);
}

LobeList openpbr_lobes(const SurfaceParams& p, Vec3f wo, bool front) noexcept {
    LobeList lobes;
    const float metal = p.base_metalness;
    const float clear = (1.0f - metal) * p.transmission_weight;
    const float opaque = (1.0f - metal) * (1.0f - p.transmission_weight);
    const float ior = modulated_ior(p.specular_ior, p.specular_weight);
    const Ggx ggx = openpbr_ggx(p.specular_roughness, p.specular_roughness_anisotropy);
    if (opaque > 0.0f) {
        const float eta = openpbr_boundary_eta(p);
        float reflected = 0.0f;
        if (eta > 1.0f + kSameIndex) {
            const float alpha = std::sqrt(ggx.ax * ggx.ay);
            reflected = alpha < kMinAlpha ? fresnel_dielectric(wo.z, eta)
                        : p.boundary      ? (*p.boundary)(wo.z)
                                          : dielectric_reflection_albedo(wo.z, alpha, eta);
            push_reflection(lobes, ggx, DielectricFresnel{eta}, p.specular_color * opaque,
                            Color(reflected));
        }
        // Albedo scaling: the base gets what the boundary lets through. OpenPBR 1.1, "Layering".
        lobes.push(DiffuseLobe{},
                   p.base_color * (Color(1.0f) - p.specular_color * reflected) * opaque);
    }
    if (metal > 0.0f) {
        const MetalFresnel fresnel{p.base_color, p.specular_color};
        push_reflection(lobes, ggx, fresnel, Color(metal * std::min(p.specular_weight, 1.0f)),
                        fresnel(wo.z));
    }
    if (clear > 0.0f) push_transmission(lobes, p, ggx, ior, front, Color(clear));
    lobes.prepare(wo);
    return lobes;
}

}  // namespace tessera
