#pragma once
// Specular lobes that see surroundings of their own: a reflection map, or the environment's image
// for reflections. What they send and what the other lobes of a point send is weighed as if each
// were alone, so that light is what the lobe that scatters it sees, whichever lobe or light chose
// the direction.

#include <bit>

#include "materials/lobe_block.h"
#include "renderer/core/warp.h"
#include "renderer/scene/scene.h"

namespace tessera {

class Apart {
public:
    explicit Apart(const Scene& scene) noexcept : scene_(scene) {}

    void clear() noexcept { lanes_ = 0; }
    /// A lane that stands on a material, seen from its front or back.
    void find(int i, std::int32_t material, bool front) noexcept {
        // From within, glass mirrors its inside.
        const bool mirrors = front || !scene_.program(material).facts().glass;
        map_[i] = mirrors ? scene_.reflection_map(material) : nullptr;
        if (map_[i] || scene_.lights().own_reflection()) lanes_ |= 1u << i;
    }
    /// Those whose specular lobes are kept apart.
    LaneMask lanes() const noexcept { return lanes_; }
    /// Those whose ray was sent by such a lobe.
    LaneMask sent() const noexcept { return sent_; }

    /// What the lobes make of a light's sample toward wi (local): f L / pdf by the power heuristic.
    template <class Lobes>
    Color weigh_light(int i, const Lobes& lobes, Vec3f wi, const LightSamples& light) const {
        const auto part = [&](bool specular, Color radiance) {
            const LobeEval e = lobes.eval(i, wi, specular);
            const float mis = light.delta[i] ? 1.0f : mis_power(light.pdf[i], e.pdf);
            return e.f * radiance * (mis / light.pdf[i]);
        };
        const Color radiance = light.radiance[i], matte = part(false, radiance);
        if (map_[i] && wi.z > 0.0f) return matte;  // the map holds the lights
        const bool own = light.surroundings[i] && scene_.lights().own_reflection();
        return matte + part(true, own ? scene_.lights().reflection(light.wi[i]) : radiance);
    }

    /// Shares of that by event.
    template <class Lobes>
    EventColors shares_of_light(int i, const Lobes& lobes, Vec3f wi,
                                const LightSamples& light) const {
        EventColors sum;
        const auto part = [&](LobePart which, bool specular, Color radiance) {
            const float pdf = lobes.eval(i, wi, specular).pdf;
            const float mis = light.delta[i] ? 1.0f : mis_power(light.pdf[i], pdf);
            const EventColors values = lobes.values(i, wi, which);
            for (int e = 0; e < kLobeEvents; ++e) sum.of[e] += values.of[e] * radiance * mis;
        };
        const Color radiance = light.radiance[i];
        part(LobePart::matte, false, radiance);
        if (map_[i] && wi.z > 0.0f) return sum;
        const bool own = light.surroundings[i] && scene_.lights().own_reflection();
        part(LobePart::specular, true, own ? scene_.lights().reflection(light.wi[i]) : radiance);
        return sum;
    }

    /// Weighs the lobes' samples. Returns the lanes that still have one.
    template <class Lobes>
    LaneMask weigh_samples(LaneMask lanes, const Lobes& lobes, LobeSamples& samples) noexcept {
        for (LaneMask m = lanes & lanes_; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            const LaneMask bit = 1u << i;
            const bool specular = lobes.took_specular(i);
            sent_ = specular ? sent_ | bit : sent_ & ~bit;
            if (samples.pdf[i] == 0.0f) continue;  // smooth: alone as it is
            const LobeEval e = lobes.eval(i, samples.wi[i], specular);
            if (!(e.pdf > 0.0f)) lanes &= ~bit;
            samples.weight.set(i, e.f / e.pdf);
            samples.pdf[i] = e.pdf;
        }
        return lanes;
    }
    /// Where a path ends that goes on toward wi (local); null: it does not.
    const ReflectionMap* end(int i, Vec3f wi) const noexcept {
        return ((lanes_ & sent_) >> i & 1u) && wi.z > 0.0f ? map_[i] : nullptr;
    }

private:
    const Scene& scene_;
    LaneMask lanes_ = 0, sent_ = 0;
    Lanes<const ReflectionMap*> map_;
};

/// Of kernels that have no such thing.
struct NoneApart {
    explicit NoneApart(const Scene&) noexcept {}
    static constexpr LaneMask sent() noexcept { return 0; }
};

}  // namespace tessera
