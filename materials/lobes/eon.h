#pragma once
// Rough diffuse reflection that keeps its energy. Portsmouth, Kutz, Hill, "EON: A Practical
// Energy-Preserving Rough Diffuse BRDF", JCGT 14(1), 2025.

#include "materials/lobe.h"
#include "renderer/core/warp.h"

namespace tessera {

/// Fujii's Oren-Nayar ("FON"): a directional albedo below one, which the rest of EON fills up.
struct Fon {
    static constexpr float kOne = 0.5f - 2.0f / (3.0f * kPi);
    static constexpr float kTwo = 2.0f / 3.0f - 28.0f / (15.0f * kPi);

    /// Directional albedo of a white surface; a polynomial within 0.1 % (EON, listing 1).
    static float albedo(float mu, float roughness) {
        const float c = 1.0f - mu;
        const float g =
            c * (0.0571085289f + c * (0.491881867f + c * (-0.332181442f + c * 0.0714429953f)));
        return (1.0f + roughness * g) / (1.0f + kOne * roughness);
    }
    static float average_albedo(float roughness) {
        return (1.0f + kTwo * roughness) / (1.0f + kOne * roughness);
    }
};

struct EonLobe {
    static constexpr bool kDelta = false, kDiffuse = true;
    Color rho{0.8f};
    float roughness = 0.5f;

    struct Lanes {
        Vec3Lanes rho;
        float roughness[kLanes];
        void set(int i, const EonLobe& l) { rho.set(i, l.rho), roughness[i] = l.roughness; }
        EonLobe get(int i) const { return {rho[i], roughness[i]}; }
    };

    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const float s = dot(wi, wo) - wi.z * wo.z;
        const float over_t = s > 0.0f ? s / std::max(wi.z, wo.z) : s;
        const float single = (1.0f + roughness * over_t) / (1.0f + Fon::kOne * roughness);
        const float missing_o = 1.0f - Fon::albedo(wo.z, roughness);
        const float missing_i = 1.0f - Fon::albedo(wi.z, roughness);
        const float missing = 1.0f - Fon::average_albedo(roughness);
        const float multiple = missing_o * missing_i / std::max(missing, 1e-7f);
        const Color f = rho * single + rho_multiple() * multiple;
        const bool above = wi.z > 0.0f;
        return {pick(above, f * (wi.z * kInvPi), Color(0.0f)), pick(above, pdf(wo, wi), 0.0f)};
    }
    // Most light follows the cosine; what a rough surface sends back at grazing angles does not.
    LobeDirection direction(Vec3f wo, Vec2f u, float choice) const {
        const float uniform = uniform_share(wo);
        const Vec3f c = warp_cosine(u);
        const SinCos a = sincos_turn(u.y);
        const float r = safe_sqrt(u.x * (2.0f - u.x));
        const Vec3f h{r * a.cos, r * a.sin, 1.0f - u.x};
        return {pick(choice < uniform, h, c), 1.0f, LobeClass::diffuse};
    }
    float spread() const { return 0.2f; }
    Color albedo(Vec3f wo) const {
        const float e = Fon::albedo(wo.z, roughness);
        return rho * e + rho_multiple() * (1.0f - e);
    }

private:
    Color rho_multiple() const {
        const float e = Fon::average_albedo(roughness);
        const Color below = Color(1.0f) - rho * (1.0f - e);
        return {rho.x * rho.x * e / below.x, rho.y * rho.y * e / below.y,
                rho.z * rho.z * e / below.z};
    }
    float uniform_share(Vec3f wo) const { return 0.5f * roughness * (1.0f - wo.z); }
    float pdf(Vec3f wo, Vec3f wi) const {
        const float uniform = uniform_share(wo);
        return uniform * (0.5f * kInvPi) + (1.0f - uniform) * wi.z * kInvPi;
    }
};

}  // namespace tessera
