#pragma once
// Lambert's reflector. Lambert, "Photometria", 1760.

#include "materials/lobe.h"
#include "renderer/core/warp.h"

namespace tessera {

struct DiffuseLobe {
    static constexpr bool kDelta = false;
    struct Lanes {
        void set(int, const DiffuseLobe&) {}
        DiffuseLobe get(int) const { return {}; }
    };

    LobeEval eval(Vec3f, Vec3f wi) const {
        const float p = std::max(wi.z, 0.0f) * kInvPi;
        return {Color(p), p};
    }
    LobeDirection direction(Vec3f, Vec2f u, float) const {
        return {warp_cosine(u), 1.0f, LobeClass::diffuse};
    }
    float spread() const { return 0.2f; }
    Color albedo(Vec3f) const { return Color(1.0f); }
};

}  // namespace tessera
