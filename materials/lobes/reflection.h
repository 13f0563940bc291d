#pragma once
// Reflection off a boundary, rough (GGX) or smooth; the boundary a dielectric or a metal.

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/lobe.h"

namespace tessera {

struct DielectricFresnel {
    float eta = 1.5f;
    Color operator()(float cos_i) const { return Color(fresnel_dielectric(cos_i, eta)); }
};

struct MetalFresnel {
    Color f0{1.0f}, f82{1.0f};
    Color operator()(float cos_i) const { return fresnel_f82(f0, f82, cos_i); }
};

template <class Fresnel>
struct RoughReflection {
    static constexpr bool kDelta = false;
    Ggx ggx;
    Fresnel fresnel;
    Color reflectance{1.0f};  // directional albedo, for choosing lobes

    // D(h) Gv(wo) / (4 wo.z) and the like with their fractions cleared: with s(w) = w.z (1 + 2
    // lambda(w)), of which nothing is divided by a grazing cosine.
    LobeEval eval(Vec3f wo, Vec3f wi) const {
        if (wi.z <= 0.0f) return {};
        const Vec3f sum = wo + wi;
        const float l2 = length2(sum);
        if (!(l2 > 0.0f)) return {};
        const float so = ggx.stretched(wo), si = ggx.stretched(wi), d = ggx.d_of(sum, l2);
        const float pdf = d / (2.0f * (wo.z + so));
        const float cos_h = std::min(0.5f * std::sqrt(l2), 1.0f);  // dot(wo, h): wo and wi are unit
        return {fresnel(cos_h) * (d * wi.z / (2.0f * (so * wi.z + si * wo.z))), pdf};
    }
    bool direction(Vec3f wo, Vec2f u, float, LobeSample& out) const {
        out = {reflect(wo, ggx.sample_visible(wo, u)),
               Color(0.0f),
               0.0f,
               LobeClass::glossy,
               false,
               1.0f,
               0.25f * std::max(ggx.ax, ggx.ay)};
        return out.wi.z > 0.0f;
    }
    bool sample(Vec3f wo, Vec2f u, float choice, LobeSample& out) const {
        return sample_by_eval(*this, wo, u, choice, out);
    }
    Color albedo(Vec3f) const { return reflectance; }
};

template <class Fresnel>
struct SmoothReflection {
    static constexpr bool kDelta = true;
    Fresnel fresnel;

    LobeEval eval(Vec3f, Vec3f) const { return {}; }
    bool sample(Vec3f wo, Vec2f, float, LobeSample& out) const {
        out = {{-wo.x, -wo.y, wo.z}, fresnel(wo.z), 0.0f, LobeClass::glossy, true, 1.0f, 0.0f};
        return true;
    }
    Color albedo(Vec3f wo) const { return fresnel(wo.z); }
};

}  // namespace tessera
