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
    bool direction(Vec3f, Vec2f u, float, LobeSample& out) const {
        out = {warp_cosine(u), Color(1.0f), 0.0f, LobeClass::diffuse, false, 1.0f, 0.2f};
        return out.wi.z > 0.0f;
    }
    bool sample(Vec3f wo, Vec2f u, float choice, LobeSample& out) const {
        if (!direction(wo, u, choice, out)) return false;
        out.pdf = out.wi.z * kInvPi;
        return true;
    }
    Color albedo(Vec3f) const { return Color(1.0f); }
};

}  // namespace tessera
