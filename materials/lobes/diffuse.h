#pragma once
// Lambert's reflector. Lambert, "Photometria", 1760.

#include "materials/lobe.h"
#include "renderer/core/warp.h"

namespace tessera {

struct DiffuseLobe {
    static constexpr bool kDelta = false;

    LobeEval eval(Vec3f, Vec3f wi) const {
        if (wi.z <= 0.0f) return {};
        const float p = wi.z * kInvPi;
        return {Color(p), p};
    }
    std::optional<LobeSample> direction(Vec3f, Vec2f u, float) const {
        const Vec3f wi = warp_cosine(u);
        if (!(wi.z > 0.0f)) return std::nullopt;
        return LobeSample{wi, Color(1.0f), 0.0f, LobeClass::diffuse, false, 1.0f, 0.2f};
    }
    std::optional<LobeSample> sample(Vec3f wo, Vec2f u, float choice) const {
        auto s = direction(wo, u, choice);
        if (s) s->pdf = s->wi.z * kInvPi;
        return s;
    }
    Color albedo(Vec3f) const { return Color(1.0f); }
};

}  // namespace tessera
