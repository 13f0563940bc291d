#pragma once
// OpenPBR Surface 1.1, the part that exists now: its parameters at one point, and the lobes they
// make. Andersson et al., "OpenPBR Surface Specification", Academy Software Foundation, 2024.

#include "materials/energy.h"
#include "materials/lobe_block.h"

namespace tessera {

/// Parameters at a point, textures read.
struct SurfaceParams {
    Color base_color{0.8f};  // base_weight included
    float base_metalness = 0;
    float specular_weight = 1;
    Color specular_color{1.0f};
    float specular_roughness = 0.3f;
    float specular_roughness_anisotropy = 0;
    float specular_ior = 1.5f;
    float transmission_weight = 0;
    Color transmission_color{1.0f};
    bool thin_walled = false;
    const ReflectionAlbedoCurve* boundary =
        nullptr;  // of the dielectric boundary if it is the same everywhere
};

/// Roughness to the two GGX alphas. OpenPBR 1.1, "Microfacet model".
Ggx openpbr_ggx(float roughness, float anisotropy);

/// Parameters with what follows from them whatever they are seen from.
struct Surface {
    SurfaceParams p;
    Ggx ggx;
    float ior = 1;           // specular_weight included
    float boundary_eta = 1;  // of the opaque base's boundary, always entered from outside: >= 1

    explicit Surface(const SurfaceParams& params);
};

/// Pushes the lobes of a lane of `lobes`, seen from lobes.wo[lane] (z > 0); front: that is on the
/// outside. Kinds that the block does not have are taken as not needed.
template <class Lobes>
void openpbr_lobes(const Surface& surface, bool front, int lane, Lobes& lobes) noexcept;

// A boundary is looked through undisturbed where the two indices agree; the half vector is
// undefined there.
inline constexpr float kSameIndex = 1e-4f;

namespace openpbr {

inline bool is_smooth(const Ggx& ggx) { return std::max(ggx.ax, ggx.ay) < kMinAlpha; }

template <class Fresnel, class Lobes>
void push_reflection(const Ggx& ggx, const Fresnel& fresnel, Color weight, Color albedo, int lane,
                     Lobes& lobes) {
    if (is_smooth(ggx)) {
        lobes.push(lane, SmoothReflection<Fresnel>{fresnel}, weight);
    } else {
        lobes.push(lane, RoughReflection<Fresnel>{ggx, fresnel, albedo}, weight);
    }
}

template <class Lobes>
void push_transmission(const Surface& surface, bool front, Color weight, int lane, Lobes& lobes) {
    const SurfaceParams& p = surface.p;
    const Ggx& ggx = surface.ggx;
    const float ior = surface.ior;
    if (p.thin_walled) {
        lobes.push(lane, ThinGlass{ior, p.specular_color, p.transmission_color}, weight);
        return;
    }
    const float eta = front ? ior : 1.0f / ior;
    if (is_smooth(ggx) || std::fabs(ior - 1.0f) < kSameIndex) {
        lobes.push(lane, SmoothGlass{eta, p.specular_color, p.transmission_color}, weight);
    } else {
        lobes.push(lane, RoughGlass{ggx, eta, p.specular_color, p.transmission_color}, weight);
    }
}

}  // namespace openpbr

template <class Lobes>
void openpbr_lobes(const Surface& surface, bool front, int lane, Lobes& lobes) noexcept {
    const SurfaceParams& p = surface.p;
    const Ggx& ggx = surface.ggx;
    const float metal = p.base_metalness;
    const float clear = (1.0f - metal) * p.transmission_weight;
    const float opaque = (1.0f - metal) * (1.0f - p.transmission_weight);
    const float cos_o = lobes.wo.z[lane];
    if (opaque > 0.0f) {
        const float eta = surface.boundary_eta;
        float reflected = 0.0f;
        if (eta > 1.0f + kSameIndex) {
            const float alpha = std::sqrt(ggx.ax * ggx.ay);
            reflected = alpha < kMinAlpha ? fresnel_dielectric(cos_o, eta)
                        : p.boundary      ? (*p.boundary)(cos_o)
                                          : dielectric_reflection_albedo(cos_o, alpha, eta);
            openpbr::push_reflection(ggx, DielectricFresnel{eta}, p.specular_color * opaque,
                                     Color(reflected), lane, lobes);
        }
        // Albedo scaling: the base gets what the boundary lets through. OpenPBR 1.1, "Layering".
        lobes.push(lane, DiffuseLobe{},
                   p.base_color * (Color(1.0f) - p.specular_color * reflected) * opaque);
    }
    if (metal > 0.0f) {
        const MetalFresnel fresnel{p.base_color, p.specular_color};
        openpbr::push_reflection(ggx, fresnel, Color(metal * std::min(p.specular_weight, 1.0f)),
                                 fresnel(cos_o), lane, lobes);
    }
    if constexpr (Lobes::template kHas<RoughGlass>) {
        if (clear > 0.0f) openpbr::push_transmission(surface, front, Color(clear), lane, lobes);
    }
}

}  // namespace tessera
