#pragma once
// The way into a translucent body: light goes on below as from Lambert's surface, the integrator
// walks it at random through the inside (renderer/integrator/walk.h).

#include "materials/lobe.h"
#include "renderer/core/warp.h"

namespace tessera {

struct SubsurfaceEntry {
    static constexpr bool kDelta = true;
    Color reflectance{0.8f};  // of the whole body, for choosing lobes and for the albedo pass

    struct Lanes {
        Vec3Lanes reflectance;
        void set(int i, const SubsurfaceEntry& l) { reflectance.set(i, l.reflectance); }
        SubsurfaceEntry get(int i) const { return {reflectance[i]}; }
    };

    SmoothSample sample(Vec3f, Vec2f u, float) const {
        const Vec3f w = warp_cosine(u);
        return {{{w.x, w.y, -w.z}, 1.0f, LobeClass::subsurface}, Color(1.0f)};
    }
    template <class Child>
    void branch(Vec3f, Child) const {}
    Color albedo(Vec3f) const { return reflectance; }
};

}  // namespace tessera
