#pragma once
// A boundary that reflects and transmits: rough (Walter et al. 2007, with visible normals), smooth,
// and thin-walled sheets. Radiance is scaled by 1/eta^2 when it crosses (Veach 1997, section 5.2).
// Fresnel gives the reflected share, colour by colour if a film lies on the boundary.

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/lobe.h"
#include "materials/lobes/reflection.h"

namespace tessera {

inline float mean_component(Color c) { return (c.x + c.y + c.z) * (1.0f / 3.0f); }

inline LobeDirection mirrored(Vec3f wo) { return {{-wo.x, -wo.y, wo.z}, 1.0f, LobeClass::glossy}; }

/// What boundaries that let light through have in common.
template <class Fresnel>
struct Glass {
    Fresnel fresnel;  // its eta: beyond over here, seen from wo
    Color reflect_tint{1.0f}, transmit_tint{1.0f};

    struct Lanes {
        typename Fresnel::Lanes fresnel;
        Vec3Lanes reflect_tint, transmit_tint;
        void set(int i, const Glass& g) {
            fresnel.set(i, g.fresnel);
            reflect_tint.set(i, g.reflect_tint);
            transmit_tint.set(i, g.transmit_tint);
        }
        Glass get(int i) const { return {fresnel.get(i), reflect_tint[i], transmit_tint[i]}; }
    };

    /// Light shared out by the reflected share f.
    Color shared(Color f) const { return reflect_tint * f + transmit_tint * (Color(1.0f) - f); }
};

/// Glass with microfacets; gain gives back what they lose to bouncing among each other.
/// Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019.
template <class Fresnel>
struct MicrofacetGlass {
    Glass<Fresnel> glass;
    Ggx ggx;
    float gain = 1;

    struct Lanes {
        typename Glass<Fresnel>::Lanes glass;
        float ax[kLanes], ay[kLanes], gain[kLanes];
        void set(int i, const MicrofacetGlass& g) {
            glass.set(i, g.glass);
            ax[i] = g.ggx.ax, ay[i] = g.ggx.ay, gain[i] = g.gain;
        }
        MicrofacetGlass get(int i) const { return {glass.get(i), {ax[i], ay[i]}, gain[i]}; }
    };
};

template <class Fresnel>
struct RoughGlass {
    static constexpr bool kDelta = false;
    MicrofacetGlass<Fresnel> m;

    struct Lanes : MicrofacetGlass<Fresnel>::Lanes {
        void set(int i, const RoughGlass& g) { MicrofacetGlass<Fresnel>::Lanes::set(i, g.m); }
        RoughGlass get(int i) const { return {MicrofacetGlass<Fresnel>::Lanes::get(i)}; }
    };

    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const float eta = m.glass.fresnel.eta;
        const bool reflected = wi.z > 0.0f;
        const Vec3f sum = wo + wi * pick(reflected, 1.0f, eta);
        const float l2 = length2(sum);
        const Vec3f up = sum / std::sqrt(l2);
        const Vec3f h = up * pick(up.z < 0.0f, -1.0f, 1.0f);
        const float oh = dot(wo, h), ih = dot(wi, h);
        const Color f = m.glass.fresnel(std::min(std::max(oh, 0.0f), 1.0f));
        const float chance = mean_component(f);
        const float visible = m.ggx.visible(wo, h);
        const float g = m.gain * m.ggx.g2(wo, {wi.x, wi.y, std::fabs(wi.z)}) / m.ggx.g1(wo);
        const float denom = ih + oh / eta;
        const float density_r = visible / (4.0f * oh);
        const float density_t = visible * std::fabs(ih) / (denom * denom);
        const Color r = m.glass.reflect_tint * f * (density_r * g);
        const Color t = m.glass.transmit_tint * (Color(1.0f) - f) * (density_t * g / (eta * eta));
        const float pdf = pick(reflected, density_r * chance, density_t * (1.0f - chance));
        const bool seen = oh > 0.0f, sided = (ih > 0.0f) == reflected;
        const bool there = (wi.z != 0.0f) & (l2 > 0.0f) & seen & sided;
        return {pick(there, pick(reflected, r, t), Color(0.0f)), pick(there, pdf, 0.0f)};
    }
    LobeDirection direction(Vec3f wo, Vec2f u, float choice) const {
        const float eta = m.glass.fresnel.eta;
        const Vec3f h = m.ggx.sample_visible(wo, u);
        const float oh = clamp01(dot(wo, h));
        const bool reflected = choice < mean_component(m.glass.fresnel(oh));
        const Vec3f r = reflect(wo, h);
        const Vec3f t = normalize(refract(wo, h, eta, refracted_cosine(oh, eta)));
        const bool up = r.z > 0.0f, down = t.z < 0.0f;
        const bool there = (oh > 0.0f) & (reflected ? up : down);
        return {pick(there, pick(reflected, r, t), Vec3f(0.0f)), pick(reflected, 1.0f, eta),
                reflected ? LobeClass::glossy : LobeClass::transmission};
    }
    float spread() const { return 0.25f * std::max(m.ggx.ax, m.ggx.ay); }
    Color albedo(Vec3f wo) const { return m.glass.shared(m.glass.fresnel(wo.z)); }
    /// What of albedo() does not go through; so of the others.
    Color reflected_albedo(Vec3f wo) const { return m.glass.reflect_tint * m.glass.fresnel(wo.z); }
};

/// Two parallel boundaries with nothing between, all bounces between them summed: the reflected
/// share of one becomes that of both.
inline Color of_both(Color f) {
    return {2.0f * f.x / (1.0f + f.x), 2.0f * f.y / (1.0f + f.y), 2.0f * f.z / (1.0f + f.z)};
}

/// A rough sheet: what passes leaves as if it had been reflected, but below.
template <class Fresnel>
struct RoughSheet {
    static constexpr bool kDelta = false;
    MicrofacetGlass<Fresnel> m;

    struct Lanes : MicrofacetGlass<Fresnel>::Lanes {
        void set(int i, const RoughSheet& g) { MicrofacetGlass<Fresnel>::Lanes::set(i, g.m); }
        RoughSheet get(int i) const { return {MicrofacetGlass<Fresnel>::Lanes::get(i)}; }
    };

    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const bool reflected = wi.z > 0.0f;
        const Vec3f up{wi.x, wi.y, std::fabs(wi.z)};
        const Vec3f sum = wo + up;
        const float l2 = length2(sum);
        const float so = m.ggx.stretched(wo), si = m.ggx.stretched(up), d = m.ggx.d_of(sum, l2);
        const float density = d / (2.0f * (wo.z + so));
        const Color f = of_both(m.glass.fresnel(std::min(0.5f * std::sqrt(l2), 1.0f)));
        const float chance = mean_component(f);
        const Color share =
            pick(reflected, m.glass.reflect_tint * f, m.glass.transmit_tint * (Color(1.0f) - f));
        const Color value = share * (m.gain * d * up.z / (2.0f * (so * up.z + si * wo.z)));
        const bool there = up.z > 0.0f;
        return {pick(there, value, Color(0.0f)),
                pick(there, density * pick(reflected, chance, 1.0f - chance), 0.0f)};
    }
    LobeDirection direction(Vec3f wo, Vec2f u, float choice) const {
        const Vec3f h = m.ggx.sample_visible(wo, u);
        const Vec3f r = reflect(wo, h);
        const bool reflected =
            choice < mean_component(of_both(m.glass.fresnel(clamp01(dot(wo, h)))));
        const Vec3f wi{r.x, r.y, pick(reflected, r.z, -r.z)};
        return {pick(r.z > 0.0f, wi, Vec3f(0.0f)), 1.0f,
                reflected ? LobeClass::glossy : LobeClass::transmission};
    }
    float spread() const { return 0.25f * std::max(m.ggx.ax, m.ggx.ay); }
    Color albedo(Vec3f wo) const { return m.glass.shared(of_both(m.glass.fresnel(wo.z))); }
    Color reflected_albedo(Vec3f wo) const {
        return m.glass.reflect_tint * of_both(m.glass.fresnel(wo.z));
    }
};

/// A smooth boundary, or a sheet of two: both share light out alike, but a sheet lets it straight
/// through.
template <class Fresnel, bool kSheet>
struct SmoothBoundary {
    static constexpr bool kDelta = true;
    Glass<Fresnel> glass;

    struct Lanes : Glass<Fresnel>::Lanes {
        void set(int i, const SmoothBoundary& g) { Glass<Fresnel>::Lanes::set(i, g.glass); }
        SmoothBoundary get(int i) const { return {Glass<Fresnel>::Lanes::get(i)}; }
    };

    SmoothSample sample(Vec3f wo, Vec2f, float choice) const {
        const Color f = reflectance(wo);
        const float chance = mean_component(f);
        return choice < chance ? reflected(wo, f * (1.0f / chance))
                               : through(wo, (Color(1.0f) - f) * (1.0f / (1.0f - chance)));
    }
    /// A ray tree's children.
    template <class Child>
    void branch(Vec3f wo, Child child) const {
        const Color f = reflectance(wo);
        child(reflected(wo, f));
        if (min_component(f) < 1.0f) child(through(wo, Color(1.0f) - f));
    }
    Color albedo(Vec3f wo) const { return glass.shared(reflectance(wo)); }
    Color reflected_albedo(Vec3f wo) const { return glass.reflect_tint * reflectance(wo); }

private:
    Color reflectance(Vec3f wo) const {
        const Color f = glass.fresnel(wo.z);
        return kSheet ? of_both(f) : f;
    }
    SmoothSample reflected(Vec3f wo, Color share) const {
        return {mirrored(wo), glass.reflect_tint * share};
    }
    SmoothSample through(Vec3f wo, Color share) const {
        if constexpr (kSheet)
            return {{-wo, 1.0f, LobeClass::transmission}, glass.transmit_tint * share};
        const float eta = glass.fresnel.eta;
        const Vec3f t = refract(wo, {0, 0, 1}, eta, refracted_cosine(wo.z, eta));
        return {{normalize(t), eta, LobeClass::transmission},
                glass.transmit_tint * share * (1.0f / (eta * eta))};
    }
};

template <class Fresnel>
using SmoothGlass = SmoothBoundary<Fresnel, false>;
template <class Fresnel>
using SmoothSheet = SmoothBoundary<Fresnel, true>;

}  // namespace tessera
