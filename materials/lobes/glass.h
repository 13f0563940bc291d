#pragma once
// A dielectric boundary that reflects and transmits: rough (Walter et al. 2007, with visible
// normals), smooth, and the thin-walled sheet. Radiance is scaled by 1/eta^2 when it crosses (Veach
// 1997, section 5.2).

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/lobe.h"

namespace tessera {

struct RoughGlass {
    static constexpr bool kDelta = false;
    Ggx ggx;
    float eta = 1.5f;  // beyond over here, seen from wo
    Color reflect_tint{1.0f}, transmit_tint{1.0f};

    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const bool reflected = wi.z > 0.0f;
        if (wi.z == 0.0f) return {};
        Vec3f h = reflected ? wo + wi : wo + wi * eta;
        const float l2 = length2(h);
        if (!(l2 > 0.0f)) return {};
        h = h / std::sqrt(l2);
        if (h.z < 0.0f) h = -h;
        const float oh = dot(wo, h), ih = dot(wi, h);
        if (oh <= 0.0f || (ih > 0.0f) != reflected) return {};
        const float fresnel = fresnel_dielectric(oh, eta);
        const float visible = ggx.visible(wo, h);
        const float g = ggx.g2(wo, {wi.x, wi.y, std::fabs(wi.z)}) / ggx.g1(wo);
        if (reflected) {
            const float pdf = visible * fresnel / (4.0f * oh);
            return {reflect_tint * (pdf * g), pdf};
        }
        const float denom = ih + oh / eta;
        const float pdf = visible * (1.0f - fresnel) * std::fabs(ih) / (denom * denom);
        return {transmit_tint * (pdf * g / (eta * eta)), pdf};
    }
    bool direction(Vec3f wo, Vec2f u, float choice, LobeSample& out) const {
        const Vec3f h = ggx.sample_visible(wo, u);
        const float oh = dot(wo, h);
        if (!(oh > 0.0f)) return false;
        float cos_t = 0;
        const float fresnel = fresnel_dielectric(oh, eta, &cos_t);
        const bool reflected = choice < fresnel;
        out = {reflected ? reflect(wo, h) : normalize(refract(wo, h, eta, cos_t)),
               Color(0.0f),
               0.0f,
               reflected ? LobeClass::glossy : LobeClass::transmission,
               false,
               reflected ? 1.0f : eta,
               0.25f * std::max(ggx.ax, ggx.ay)};
        return reflected ? out.wi.z > 0.0f : out.wi.z < 0.0f;
    }
    bool sample(Vec3f wo, Vec2f u, float choice, LobeSample& out) const {
        return sample_by_eval(*this, wo, u, choice, out);
    }
    Color albedo(Vec3f wo) const {
        const float f = fresnel_dielectric(wo.z, eta);
        return reflect_tint * f + transmit_tint * (1.0f - f);
    }
};

struct SmoothGlass {
    static constexpr bool kDelta = true;
    float eta = 1.5f;
    Color reflect_tint{1.0f}, transmit_tint{1.0f};

    LobeEval eval(Vec3f, Vec3f) const { return {}; }
    bool sample(Vec3f wo, Vec2f, float choice, LobeSample& out) const {
        float cos_t = 0;
        const float fresnel = fresnel_dielectric(wo.z, eta, &cos_t);
        out = choice < fresnel ? reflected(wo) : transmitted(wo, cos_t);
        return true;
    }
    /// The two children of a ray tree, weighted by nothing: the caller multiplies by Fresnel's
    /// shares.
    LobeSample reflected(Vec3f wo) const {
        return {{-wo.x, -wo.y, wo.z}, reflect_tint, 0.0f, LobeClass::glossy, true, 1.0f, 0.0f};
    }
    LobeSample transmitted(Vec3f wo, float cos_t) const {
        return {normalize(refract(wo, {0, 0, 1}, eta, cos_t)),
                transmit_tint * (1.0f / (eta * eta)),
                0.0f,
                LobeClass::transmission,
                true,
                eta,
                0.0f};
    }
    Color albedo(Vec3f wo) const {
        const float f = fresnel_dielectric(wo.z, eta);
        return reflect_tint * f + transmit_tint * (1.0f - f);
    }
};

/// Two parallel boundaries with nothing between: all internal bounces summed, no refraction in
/// total.
struct ThinGlass {
    static constexpr bool kDelta = true;
    float eta = 1.5f;
    Color reflect_tint{1.0f}, transmit_tint{1.0f};

    float reflectance(float cos_i) const {
        const float f = fresnel_dielectric(cos_i, eta);
        return 2.0f * f / (1.0f + f);
    }
    LobeEval eval(Vec3f, Vec3f) const { return {}; }
    bool sample(Vec3f wo, Vec2f, float choice, LobeSample& out) const {
        out = choice < reflectance(wo.z) ? reflected(wo) : transmitted(wo);
        return true;
    }
    LobeSample reflected(Vec3f wo) const {
        return {{-wo.x, -wo.y, wo.z}, reflect_tint, 0.0f, LobeClass::glossy, true, 1.0f, 0.0f};
    }
    LobeSample transmitted(Vec3f wo) const {
        return {-wo, transmit_tint, 0.0f, LobeClass::transmission, true, 1.0f, 0.0f};
    }
    Color albedo(Vec3f wo) const {
        const float r = reflectance(wo.z);
        return reflect_tint * r + transmit_tint * (1.0f - r);
    }
};

}  // namespace tessera
