#pragma once
// OpenPBR Surface 1.1: from a surface's parameters to its lobes. Fuzz over coat over a base that is
// metal, glass, or a glossy diffuse or translucent body. Each layer is given what the ones above it
// let through (albedo scaling), so that none makes energy.

#include "materials/lobe_block.h"
#include "materials/surface/surface.h"

namespace tessera {

/// How a surface is looked at. Directions are local to the lane's shading frame.
struct View {
    bool front = true;  // from outside
    bool walks = true;  // translucent bodies are walked through; else they are diffuse
    float eta = 0;      // index beyond over here for glass; 0: by the surface's ior, against air
    float finest = 0;   // length by which rays start off the surface: finer is not resolved
    Frame coat;         // the coat's own frame, with wo on its side
};

namespace openpbr {

inline Color power(Color c, float e) {
    return {std::pow(c.x, e), std::pow(c.y, e), std::pow(c.z, e)};
}

template <class Fresnel, class Lobes>
void push_reflection(const Ggx& ggx, const Fresnel& fresnel, Color weight, Color albedo, int lane,
                     Lobes& lobes) {
    if (is_smooth(ggx))
        lobes.push(lane, SmoothReflection<Fresnel>{fresnel}, weight);
    else
        lobes.push(lane, RoughReflection<Fresnel>{ggx, fresnel, albedo}, weight);
}

/// Pushes the fuzz; returns what it lets through.
template <class Lobes>
Color push_fuzz(const SurfaceParams& p, int lane, Lobes& lobes) {
    const FuzzLobe fuzz = FuzzLobe::seen_at(lobes.wo.z[lane], p.fuzz_roughness);
    lobes.push(lane, fuzz, p.fuzz_color * p.fuzz_weight);
    return Color(1.0f - p.fuzz_weight * fuzz.reflectance);
}

/// What comes through the layers above, of light that lobes below send: about the mirror direction,
/// or all around.
struct Passed {
    Color glossy{1.0f}, matte{1.0f};
};

/// Pushes the coat under `weight`; returns what reaches the base and comes back through it.
/// OpenPBR 1.1, "Coat": absorption along both refracted rays, darkening by internal reflection. The
/// way in is not asked for when a lobe's weight is made: for mirrors it is as long as the way out,
/// for diffuse lobes the mean of all, for what lies between a mixture by roughness.
template <class Lobes>
Passed push_coat(const Surface& surface, const View& view, Color weight, int lane, Lobes& lobes) {
    const SurfaceParams& p = surface.p;
    const float cos_o = std::max(view.coat.to_local(lobes.wo[lane]).z, 1e-4f);
    const float reflected = surface.coat_albedo(cos_o);
    const DielectricFresnel fresnel{p.coat_ior};
    using Rough = RoughReflection<DielectricFresnel>;
    using Smooth = SmoothReflection<DielectricFresnel>;
    const Color amount = weight * p.coat_weight;
    if (is_smooth(surface.coat_ggx))
        lobes.push(lane, Framed<Smooth>{{fresnel}, view.coat}, amount);
    else
        lobes.push(lane, Framed<Rough>{{surface.coat_ggx, fresnel, Color(reflected)}, view.coat},
                   amount);
    const float way_out = 1.0f / std::max(refracted_cosine(cos_o, p.coat_ior), 1e-3f);
    const float mirrored = fresnel_dielectric(cos_o, p.coat_ior);
    const float k = mirrored + (surface.coat_reflection - mirrored) * surface.coat_spread;
    const auto dark = [&](float below) {
        const float darkened = (1.0f - k) / std::max(1.0f - below * k, 1e-6f);
        return 1.0f + (std::min(darkened, 1.0f) - 1.0f) * p.coat_darkening;
    };
    const Color& b = surface.below_coat;
    const Color through = Color(dark(b.x), dark(b.y), dark(b.z)) * (1.0f - reflected);
    // coat_color is what is left after both ways, each straight.
    const auto under = [&](float way_in) {
        const Color tint = power(p.coat_color, 0.5f * (way_in + way_out));
        return lerp(Color(1.0f), tint * through, p.coat_weight);
    };
    const float way_glossy = way_out + (surface.coat_way - way_out) * p.specular_roughness;
    return {under(way_glossy), under(surface.coat_way)};
}

template <class Lobes>
void push_metal(const Surface& surface, Color weight, int lane, Lobes& lobes) {
    const SurfaceParams& p = surface.p;
    const MetalFresnel fresnel{p.base_color * p.base_weight, p.specular_color};
    const float cos_o = lobes.wo.z[lane], e = surface.metal_albedo(cos_o);
    // What bounces among the microfacets is tinted once more at each bounce. Turquin 2019, eq. 16.
    const Color gain = Color(1.0f) + fresnel.f0 * ((1.0f - e) / e);
    const Color amount = weight * gain * std::min(p.specular_weight, 1.0f);
    if constexpr (Lobes::template kHas<RoughReflection<FilmFresnel>>) {
        if (p.thin_film_weight > 0.0f) {
            FilmFresnel film = surface.film_on(1.0f, surface.film_outside);
            film.metal = 1.0f, film.f0 = fresnel.f0, film.f82 = fresnel.f82;
            return push_reflection(surface.ggx, film, amount, film(cos_o) * e, lane, lobes);
        }
    }
    push_reflection(surface.ggx, fresnel, amount, fresnel(cos_o) * e, lane, lobes);
}

/// Pushes the opaque base's boundary; returns the share that it reflects.
template <class Lobes>
Color push_boundary(const Surface& surface, Color weight, int lane, Lobes& lobes) {
    const SurfaceParams& p = surface.p;
    const float eta = surface.boundary_eta, cos_o = lobes.wo.z[lane];
    if (!(eta > 1.0f + kSameIndex)) return Color(0.0f);
    const Color amount = weight * p.specular_color;
    if constexpr (Lobes::template kHas<RoughReflection<FilmFresnel>>) {
        if (p.thin_film_weight > 0.0f) {
            const Color reflected = surface.film_albedo(cos_o);
            push_reflection(surface.ggx, surface.boundary_film, amount, reflected, lane, lobes);
            return p.specular_color * reflected;
        }
    }
    const float bare = surface.boundary_albedo(cos_o);
    push_reflection(surface.ggx, DielectricFresnel{eta}, amount, Color(bare), lane, lobes);
    return p.specular_color * bare;
}

/// The share of each channel that is walked through a translucent body. Where a free path comes
/// near the length by which rays start off the surface, walks would start too deep and come out too
/// dark: their limit, Lambert's surface of the same albedo, takes their place. At the lower bound a
/// start is off by a hundredth of a free path.
inline Color walked_share(const SurfaceParams& p, float finest) {
    constexpr float kNone = 100.0f, kAll = 400.0f;
    const auto share = [&](float scale) {
        const float paths = scale * p.subsurface_radius;
        const float t =
            clamp01((paths - kNone * finest) / std::max((kAll - kNone) * finest, 1e-30f));
        return t * t * (3.0f - 2.0f * t);
    };
    const Color& s = p.subsurface_radius_scale;
    return {share(s.x), share(s.y), share(s.z)};
}

/// The diffuse or translucent body.
template <class Lobes>
void push_body(const SurfaceParams& p, const View& view, Color weight, int lane, Lobes& lobes) {
    float diffuse = 1.0f;
    Color also(0.0f);  // what a body that is not walked through adds to the diffuse colour
    if constexpr (Lobes::template kHas<SubsurfaceEntry>) {
        const float share = p.subsurface_weight;
        diffuse = 1.0f - share;
        const float forward = 0.5f * (1.0f + p.subsurface_scatter_anisotropy);
        if (share > 0.0f && p.thin_walled) {
            lobes.push(lane, DiffuseTransmission{},
                       weight * p.subsurface_color * (share * forward));
            also = p.subsurface_color * (share * (1.0f - forward));
        } else if (share > 0.0f && view.front && view.walks) {
            const Color walked = walked_share(p, view.finest) * share;
            lobes.push(lane, SubsurfaceEntry{p.subsurface_color}, weight * walked);
            also = p.subsurface_color * (Color(share) - walked);
        } else {
            also = p.subsurface_color * share;
        }
    } else {
        also = p.subsurface_color * p.subsurface_weight;
        diffuse = 1.0f - p.subsurface_weight;
    }
    const Color rho = p.base_color * p.base_weight;
    if constexpr (Lobes::template kHas<EonLobe>) {
        if (p.base_diffuse_roughness > 0.0f) {
            lobes.push(lane, EonLobe{rho, p.base_diffuse_roughness}, weight * diffuse);
            lobes.push(lane, DiffuseLobe{}, weight * also);
            return;
        }
    }
    lobes.push(lane, DiffuseLobe{}, weight * (rho * diffuse + also));
}

template <class Fresnel, class Lobes>
void push_glass(const Surface& surface, const Fresnel& fresnel, Color weight, int lane,
                Lobes& lobes) {
    const SurfaceParams& p = surface.p;
    const Color tint = p.transmission_depth > 0.0f ? Color(1.0f) : p.transmission_color;
    const Glass<Fresnel> glass{fresnel, p.specular_color, tint};
    const float cos_o = lobes.wo.z[lane], eta = fresnel.eta;
    const bool smooth = is_smooth(surface.ggx);
    // What a film takes from one side to the other is in no table: its losses are not given back.
    constexpr bool kBare = std::is_same_v<Fresnel, DielectricFresnel>;
    if (p.thin_walled) {
        if (smooth) return lobes.push(lane, SmoothSheet<Fresnel>{glass}, weight);
        // Both sides lose alike, whatever Fresnel says.
        const float gain = 1.0f / surface.metal_albedo(cos_o);
        return lobes.push(lane, RoughSheet<Fresnel>{{glass, surface.ggx, gain}}, weight);
    }
    if (smooth || std::fabs(eta - 1.0f) < kSameIndex)
        return lobes.push(lane, SmoothGlass<Fresnel>{glass}, weight);
    const float gain = kBare ? 1.0f / surface.glass_albedo_for(cos_o, eta) : 1.0f;
    lobes.push(lane, RoughGlass<Fresnel>{{glass, surface.ggx, gain}}, weight);
}

template <class Lobes>
void push_transmission(const Surface& surface, const View& view, Color weight, int lane,
                       Lobes& lobes) {
    const float against_air =
        view.front || surface.p.thin_walled ? surface.ior : 1.0f / surface.ior;
    const float eta = view.eta > 0.0f ? view.eta : against_air;
    if constexpr (Lobes::template kHas<RoughGlass<FilmFresnel>>) {
        if (surface.p.thin_film_weight > 0.0f) {
            const bool within = !view.front && !surface.p.thin_walled;
            const float outside = within ? surface.ior : surface.film_outside;
            return push_glass(surface, surface.film_on(eta, outside), weight, lane, lobes);
        }
    }
    push_glass(surface, DielectricFresnel{eta}, weight, lane, lobes);
}

}  // namespace openpbr

/// Pushes the lobes of a lane of `lobes`, seen from lobes.wo[lane] (z > 0). Kinds that the block
/// does not have are taken as not needed.
template <class Lobes>
void openpbr_lobes(const Surface& surface, const View& view, int lane, Lobes& lobes) noexcept {
    const SurfaceParams& p = surface.p;
    const float metal = p.base_metalness;
    const float clear = (1.0f - metal) * p.transmission_weight;
    const float opaque = (1.0f - metal) * (1.0f - p.transmission_weight);
    Color weight(1.0f);
    openpbr::Passed below;
    if constexpr (Lobes::template kHas<FuzzLobe>) {
        // The layers lie on the outside; through glass they are not seen from within.
        const bool outside = view.front || clear == 0.0f;
        if (p.fuzz_weight > 0.0f && outside) weight = openpbr::push_fuzz(p, lane, lobes);
        if (p.coat_weight > 0.0f && outside)
            below = openpbr::push_coat(surface, view, weight, lane, lobes);
    }
    const Color glossy = weight * below.glossy, matte = weight * below.matte;
    if (opaque > 0.0f) {
        const Color reflected = openpbr::push_boundary(surface, glossy * opaque, lane, lobes);
        openpbr::push_body(p, view, matte * (Color(1.0f) - reflected) * opaque, lane, lobes);
    }
    if (metal > 0.0f) openpbr::push_metal(surface, glossy * metal, lane, lobes);
    if constexpr (Lobes::template kHas<RoughGlass<DielectricFresnel>>) {
        if (clear > 0.0f) openpbr::push_transmission(surface, view, glossy * clear, lane, lobes);
    }
}

}  // namespace tessera
