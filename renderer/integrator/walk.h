#pragma once
// A random walk through a body that scatters, until a surface is met. Distances by one channel at a
// time, weighed by all of them: Chiang, Kutz, Burley, "Practical and Controllable Subsurface
// Scattering for Production Path Tracing", SIGGRAPH Talks 2016, with the one-sample balance
// heuristic over channels of Wilkie et al., "Hero Wavelength Spectral Sampling", EGSR 2014.

#include <cmath>

#include "materials/medium.h"
#include "renderer/core/frame.h"
#include "renderer/core/robust.h"
#include "renderer/core/sampler.h"
#include "renderer/scene/scene.h"

namespace tessera {

/// Numbers of a walk, whose length is not known: hashed, not from the sampler's points.
class WalkNumbers {
public:
    explicit WalkNumbers(std::uint32_t seed) noexcept : seed_(seed) {}
    float next() noexcept {
        return static_cast<float>(hash_combine(seed_, count_++) >> 8) * 0x1p-24f;
    }
    std::uint32_t seed() const noexcept { return hash_combine(seed_, count_); }

private:
    std::uint32_t seed_, count_ = 0;
};

/// Henyey & Greenstein, "Diffuse Radiation in the Galaxy", 1941: a direction after scattering.
inline Vec3f scatter_direction(Vec3f d, float g, Vec2f u) noexcept {
    float cosine = 1.0f - 2.0f * u.x;
    if (std::fabs(g) > 1e-3f) {
        const float s = (1.0f - g * g) / (1.0f - g + 2.0f * g * u.x);
        cosine = (1.0f + g * g - s * s) / (2.0f * g);
    }
    cosine = std::fmin(std::fmax(cosine, -1.0f), 1.0f);
    const float sine = safe_sqrt(1.0f - cosine * cosine);
    const SinCos a = sincos_turn(u.y);
    return normalize(Frame(d).to_world({sine * a.cos, sine * a.sin, cosine}));
}

struct WalkEnd {
    bool arrived = false;    // else the light was lost on the way
    bool scattered = false;  // at least once
    Hit hit;                 // no valid one: it left through a hole
    int rays = 0;
};

/// Walks from ray (unit direction) through the medium; ray becomes the last stretch, throughput is
/// weighed. trace(ray, seed, hit) finds the next surface.
template <class Trace>
WalkEnd walk(const Medium& medium, std::uint32_t seed, Ray& ray, Color& throughput,
             Trace trace) noexcept {
    constexpr int kMaxSteps = 4096, kSureSteps = 16;
    WalkNumbers u(seed);
    WalkEnd end;
    const float before = max_component(throughput);
    for (int step = 0; step < kMaxSteps; ++step) {
        // Channels that carry more are asked more often.
        const Color chance = throughput * (1.0f / (throughput.x + throughput.y + throughput.z));
        const float pick_channel = u.next();
        const int channel =
            pick_channel < chance.x ? 0 : (pick_channel < chance.x + chance.y ? 1 : 2);
        const float rate = medium.extinction[channel];
        const float t = rate > 0.0f ? -std::log(1.0f - u.next()) / rate : kInfinity;
        ray.t_max = t;
        end.hit = Hit{};
        trace(ray, u.seed(), end.hit);
        ++end.rays;
        const bool met = end.hit.valid() || t == kInfinity;
        const float way = end.hit.valid() ? end.hit.t : t;
        const auto passed = [&](float e) { return std::exp(-e * way); };
        Color through = met && !end.hit.valid()
                            ? Color(1.0f)
                            : Color{passed(medium.extinction.x), passed(medium.extinction.y),
                                    passed(medium.extinction.z)};
        if (met) {
            const float density = dot(chance, through);
            if (!(density > 0.0f)) return end;
            throughput *= through * (1.0f / density);
            end.arrived = max_component(throughput) > 0.0f;
            return end;
        }
        const float density = dot(chance, through * medium.extinction);
        if (!(density > 0.0f)) return end;
        throughput *= through * medium.extinction * medium.albedo * (1.0f / density);
        const float left = max_component(throughput);
        if (!(left > 0.0f)) return end;
        if (step >= kSureSteps) {
            const float survive = std::fmin(left / before, 1.0f);
            if (u.next() >= survive) return end;
            throughput *= 1.0f / survive;
        }
        end.scattered = true;
        const Vec3f o = ray.o + ray.d * t;
        const Vec2f v{u.next(), u.next()};
        ray = Ray{o, scatter_direction(ray.d, medium.anisotropy, v)};
        if (!traceable(ray.o, ray.d)) return end;
    }
    return end;
}

}  // namespace tessera
