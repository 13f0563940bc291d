#pragma once
// Lambert's reflector ("Photometria", 1760), and the sheet that lets diffuse light through.

#include "materials/lobe.h"
#include "renderer/core/warp.h"

namespace tessera {

/// The lanes of a lobe without parameters.
template <class Lobe>
struct NoParameters {
    void set(int, const Lobe&) {}
    Lobe get(int) const { return {}; }
};

struct DiffuseLobe {
    static constexpr bool kDelta = false, kDiffuse = true;
    using Lanes = NoParameters<DiffuseLobe>;

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

/// Lambert's law on the other side.
struct DiffuseTransmission {
    static constexpr bool kDelta = false;
    using Lanes = NoParameters<DiffuseTransmission>;

    LobeEval eval(Vec3f, Vec3f wi) const {
        const float p = std::max(-wi.z, 0.0f) * kInvPi;
        return {Color(p), p};
    }
    LobeDirection direction(Vec3f, Vec2f u, float) const {
        const Vec3f w = warp_cosine(u);
        return {{w.x, w.y, -w.z}, 1.0f, LobeClass::diffuse};
    }
    float spread() const { return 0.2f; }
    Color albedo(Vec3f) const { return Color(1.0f); }
};

}  // namespace tessera
