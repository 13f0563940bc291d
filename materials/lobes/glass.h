#pragma once
// A dielectric boundary that reflects and transmits: rough (Walter et al. 2007, with visible
// normals), smooth, and the thin-walled sheet. Radiance is scaled by 1/eta^2 when it crosses (Veach
// 1997, section 5.2).

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/lobe.h"

namespace tessera {

/// What boundaries that let light through have in common.
struct GlassLanes {
    float eta[kLanes];
    Vec3Lanes reflect_tint, transmit_tint;

    template <class Glass>
    void set(int i, const Glass& g) {
        eta[i] = g.eta;
        reflect_tint.set(i, g.reflect_tint);
        transmit_tint.set(i, g.transmit_tint);
    }
};

inline LobeDirection mirrored(Vec3f wo) { return {{-wo.x, -wo.y, wo.z}, 1.0f, LobeClass::glossy}; }

struct RoughGlass {
    static constexpr bool kDelta = false;
    Ggx ggx;
    float eta = 1.5f;  // beyond over here, seen from wo
    Color reflect_tint{1.0f}, transmit_tint{1.0f};

    struct Lanes : GlassLanes {
        float ax[kLanes], ay[kLanes];
        void set(int i, const RoughGlass& g) {
            GlassLanes::set(i, g);
            ax[i] = g.ggx.ax, ay[i] = g.ggx.ay;
        }
        RoughGlass get(int i) const {
            return {{ax[i], ay[i]}, eta[i], reflect_tint[i], transmit_tint[i]};
        }
    };

    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const bool reflected = wi.z > 0.0f;
        const Vec3f sum = wo + wi * pick(reflected, 1.0f, eta);
        const float l2 = length2(sum);
        const Vec3f up = sum / std::sqrt(l2);
        const Vec3f h = up * pick(up.z < 0.0f, -1.0f, 1.0f);
        const float oh = dot(wo, h), ih = dot(wi, h);
        const float fresnel = fresnel_dielectric(std::min(std::max(oh, 0.0f), 1.0f), eta);
        const float visible = ggx.visible(wo, h);
        const float g = ggx.g2(wo, {wi.x, wi.y, std::fabs(wi.z)}) / ggx.g1(wo);
        const float denom = ih + oh / eta;
        const float pdf_r = visible * fresnel / (4.0f * oh);
        const float pdf_t = visible * (1.0f - fresnel) * std::fabs(ih) / (denom * denom);
        const Color f =
            pick(reflected, reflect_tint * (pdf_r * g), transmit_tint * (pdf_t * g / (eta * eta)));
        const bool there = (wi.z != 0.0f) & (l2 > 0.0f) & (oh > 0.0f) & ((ih > 0.0f) == reflected);
        return {pick(there, f, Color(0.0f)), pick(there, pick(reflected, pdf_r, pdf_t), 0.0f)};
    }
    LobeDirection direction(Vec3f wo, Vec2f u, float choice) const {
        const Vec3f h = ggx.sample_visible(wo, u);
        const float oh = dot(wo, h);
        float cos_t = 0;
        const float fresnel = fresnel_dielectric(clamp01(oh), eta, &cos_t);
        const bool reflected = choice < fresnel;
        const Vec3f r = reflect(wo, h), t = normalize(refract(wo, h, eta, cos_t));
        const bool there = (oh > 0.0f) & (reflected ? r.z > 0.0f : t.z < 0.0f);
        return {pick(there, pick(reflected, r, t), Vec3f(0.0f)), pick(reflected, 1.0f, eta),
                reflected ? LobeClass::glossy : LobeClass::transmission};
    }
    float spread() const { return 0.25f * std::max(ggx.ax, ggx.ay); }
    Color albedo(Vec3f wo) const {
        const float f = fresnel_dielectric(wo.z, eta);
        return reflect_tint * f + transmit_tint * (1.0f - f);
    }
};

struct SmoothGlass {
    static constexpr bool kDelta = true;
    float eta = 1.5f;
    Color reflect_tint{1.0f}, transmit_tint{1.0f};

    struct Lanes : GlassLanes {
        SmoothGlass get(int i) const { return {eta[i], reflect_tint[i], transmit_tint[i]}; }
    };

    SmoothSample sample(Vec3f wo, float choice) const {
        float cos_t = 0;
        const float fresnel = fresnel_dielectric(wo.z, eta, &cos_t);
        return choice < fresnel ? SmoothSample{mirrored(wo), reflect_tint} : through(wo, cos_t);
    }
    template <class Child>
    void branch(Vec3f wo, Child child) const {
        float cos_t = 0;
        const float fresnel = fresnel_dielectric(wo.z, eta, &cos_t);
        child(SmoothSample{mirrored(wo), reflect_tint}, fresnel);
        if (fresnel < 1.0f) child(through(wo, cos_t), 1.0f - fresnel);
    }
    Color albedo(Vec3f wo) const {
        const float f = fresnel_dielectric(wo.z, eta);
        return reflect_tint * f + transmit_tint * (1.0f - f);
    }

private:
    SmoothSample through(Vec3f wo, float cos_t) const {
        return {{normalize(refract(wo, {0, 0, 1}, eta, cos_t)), eta, LobeClass::transmission},
                transmit_tint * (1.0f / (eta * eta))};
    }
};

/// Two parallel boundaries with nothing between: all internal bounces summed, no refraction in
/// total.
struct ThinGlass {
    static constexpr bool kDelta = true;
    float eta = 1.5f;
    Color reflect_tint{1.0f}, transmit_tint{1.0f};

    struct Lanes : GlassLanes {
        ThinGlass get(int i) const { return {eta[i], reflect_tint[i], transmit_tint[i]}; }
    };

    SmoothSample sample(Vec3f wo, float choice) const {
        return choice < reflectance(wo.z) ? SmoothSample{mirrored(wo), reflect_tint}
                                          : SmoothSample{through(wo), transmit_tint};
    }
    template <class Child>
    void branch(Vec3f wo, Child child) const {
        const float r = reflectance(wo.z);
        child(SmoothSample{mirrored(wo), reflect_tint}, r);
        child(SmoothSample{through(wo), transmit_tint}, 1.0f - r);
    }
    Color albedo(Vec3f wo) const {
        const float r = reflectance(wo.z);
        return reflect_tint * r + transmit_tint * (1.0f - r);
    }

private:
    float reflectance(float cos_i) const {
        const float f = fresnel_dielectric(cos_i, eta);
        return 2.0f * f / (1.0f + f);
    }
    static LobeDirection through(Vec3f wo) { return {-wo, 1.0f, LobeClass::transmission}; }
};

}  // namespace tessera
