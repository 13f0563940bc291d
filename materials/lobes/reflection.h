#pragma once
// Reflection off a boundary, rough (GGX) or smooth; the boundary a dielectric or a metal.

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/lobe.h"

namespace tessera {

struct DielectricFresnel {
    float eta = 1.5f;
    Color operator()(float cos_i) const { return Color(fresnel_dielectric(cos_i, eta)); }

    struct Lanes {
        float eta[kLanes];
        void set(int i, const DielectricFresnel& f) { eta[i] = f.eta; }
        DielectricFresnel get(int i) const { return {eta[i]}; }
    };
};

struct MetalFresnel {
    Color f0{1.0f}, f82{1.0f};
    Color operator()(float cos_i) const { return fresnel_f82(f0, f82, cos_i); }

    struct Lanes {
        Vec3Lanes f0, f82;
        void set(int i, const MetalFresnel& f) { f0.set(i, f.f0), f82.set(i, f.f82); }
        MetalFresnel get(int i) const { return {f0[i], f82[i]}; }
    };
};

template <class Fresnel>
struct RoughReflection {
    static constexpr bool kDelta = false;
    Ggx ggx;
    Fresnel fresnel;
    Color reflectance{1.0f};  // directional albedo, for choosing lobes

    struct Lanes {
        float ax[kLanes], ay[kLanes];
        typename Fresnel::Lanes fresnel;
        Vec3Lanes reflectance;
        void set(int i, const RoughReflection& l) {
            ax[i] = l.ggx.ax, ay[i] = l.ggx.ay;
            fresnel.set(i, l.fresnel);
            reflectance.set(i, l.reflectance);
        }
        RoughReflection get(int i) const {
            return {{ax[i], ay[i]}, fresnel.get(i), reflectance[i]};
        }
    };

    // D(h) Gv(wo) / (4 wo.z) and the like with their fractions cleared: with s(w) = w.z (1 + 2
    // lambda(w)), of which nothing is divided by a grazing cosine.
    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const Vec3f sum = wo + wi;
        const float l2 = length2(sum);
        const float so = ggx.stretched(wo), si = ggx.stretched(wi), d = ggx.d_of(sum, l2);
        const float pdf = d / (2.0f * (wo.z + so));
        const float cos_h = std::min(0.5f * std::sqrt(l2), 1.0f);  // dot(wo, h): wo and wi are unit
        const Color f = fresnel(cos_h) * (d * wi.z / (2.0f * (so * wi.z + si * wo.z)));
        const bool above = wi.z > 0.0f;
        return {pick(above, f, Color(0.0f)), pick(above, pdf, 0.0f)};
    }
    LobeDirection direction(Vec3f wo, Vec2f u, float) const {
        const Vec3f wi = reflect(wo, ggx.sample_visible(wo, u));
        return {pick(wi.z > 0.0f, wi, Vec3f(0.0f)), 1.0f, LobeClass::glossy};
    }
    float spread() const { return 0.25f * std::max(ggx.ax, ggx.ay); }
    Color albedo(Vec3f) const { return reflectance; }
};

template <class Fresnel>
struct SmoothReflection {
    static constexpr bool kDelta = true;
    Fresnel fresnel;

    struct Lanes {
        typename Fresnel::Lanes fresnel;
        void set(int i, const SmoothReflection& l) { fresnel.set(i, l.fresnel); }
        SmoothReflection get(int i) const { return {fresnel.get(i)}; }
    };

    SmoothSample sample(Vec3f wo, Vec2f, float) const {
        return {{{-wo.x, -wo.y, wo.z}, 1.0f, LobeClass::glossy}, fresnel(wo.z)};
    }
    template <class Child>
    void branch(Vec3f wo, Child child) const {
        child(sample(wo, {}, 0.0f));
    }
    Color albedo(Vec3f wo) const { return fresnel(wo.z); }
};

}  // namespace tessera
