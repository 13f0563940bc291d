#pragma once
// What one path is inside of: bodies of glass, or a translucent body that it walks through.

#include "materials/dispersion.h"
#include "materials/lobe.h"
#include "materials/program.h"
#include "renderer/core/sampler.h"
#include "renderer/core/surface_point.h"
#include "renderer/integrator/medium_stack.h"

namespace tessera {

/// Share of light left after a way through the medium. Lambert, "Photometria", 1760; Beer 1852.
inline Color transmittance(const Medium& m, float way) noexcept {
    const auto left = [&](float e) { return e > 0.0f ? std::exp(-e * way) : 1.0f; };
    return {left(m.extinction.x), left(m.extinction.y), left(m.extinction.z)};
}

class Inside {
public:
    void reset() noexcept {
        stack_.clear();
        walking_ = leaves_body_ = false;
        wave_ = 0.0f;
        passes_ = 0;
    }

    /// What is here, to be gone through; null: nothing.
    const Medium* medium() const noexcept {
        const MediumStack::Body* here = stack_.here();
        return here ? &here->medium : nullptr;
    }
    /// The medium that the next stretch of the path is scattered by; null: none.
    const Medium* to_walk() const noexcept {
        if (walking_) return &body_;
        const Medium* here = medium();
        return here && here->scatters() ? here : nullptr;
    }

    /// Arrives at s along d after a way. Returns what of the light passed.
    Color arrive(const SurfacePoint& s, Vec3f d, float way) noexcept {
        const bool walked = to_walk() != nullptr;
        leaves_body_ = walking_ && s.material == body_material_ && dot(s.ng, d) > 0.0f;
        walking_ = false;
        eta_ = 0.0f;
        const Medium* here = medium();
        return walked || !here || here->empty() ? Color(1.0f) : transmittance(*here, way);
    }
    /// Whether that is a body whose surface light entered by subsurface scattering.
    bool in_body() const noexcept { return walking_; }
    /// The path arrived at the surface of the body that it was in: there it is diffuse light.
    bool leaves_body() const noexcept { return leaves_body_; }

    /// At a boundary of glass. False: there is none, another body fills the place.
    bool meet_glass(const ShaderProgram& program, const Surface& surface, std::int32_t material,
                    bool entering, const ShadeInput& in, const TextureStore* store,
                    std::uint32_t seed) noexcept {
        const int priority = program.dielectric_priority();
        const MediumStack::Body* here = stack_.here();
        if (entering && here && here->priority > priority) {
            stack_.enter({material, priority, surface.ior, program.transmission(in, store)});
            return false;
        }
        if (!entering && here && here->material != material && stack_.holds(material)) {
            stack_.leave(material);
            return false;
        }
        float ior = surface.ior;
        if (program.facts().dispersion) {
            const float u = static_cast<float>(hash_combine(seed, 0x77617665u) >> 8) * 0x1p-24f;
            next_wave_ = wave_ > 0.0f ? wave_ : kShortestWave + u * (kLongestWave - kShortestWave);
            const float scale = std::max(surface.p.transmission_dispersion_scale, 1e-6f);
            ior = dispersed_ior(ior, surface.p.transmission_dispersion_abbe_number / scale,
                                next_wave_);
        }
        next_ior_ = ior;
        const MediumStack::Body* other = entering ? here : stack_.here(material);
        const float beyond = other ? other->ior : 1.0f;
        eta_ = entering ? ior / beyond : beyond / ior;
        return true;
    }
    /// Index beyond over here at the boundary; 0: it is that of the surface against air.
    float eta() const noexcept { return eta_; }
    bool may_pass() noexcept { return ++passes_ < 256; }

    /// The path goes on by a lobe of this class. Returns the tint that it takes.
    Color scatter(LobeClass cls, const ShaderProgram& program, std::int32_t material, bool front,
                  const ShadeInput& in, const TextureStore* store) noexcept {
        if (leaves_body_) return Color(1.0f);
        if (cls == LobeClass::subsurface) {
            walking_ = true;
            body_ = program.subsurface(in, store);
            body_material_ = material;
        }
        if (cls != LobeClass::transmission || !program.facts().glass) return Color(1.0f);
        if (front)
            stack_.enter({material, program.dielectric_priority(), next_ior_,
                          program.transmission(in, store)});
        else
            stack_.leave(material);
        if (!program.facts().dispersion || wave_ > 0.0f) return Color(1.0f);
        wave_ = next_wave_;
        return wave_response(wave_);
    }

private:
    MediumStack stack_;
    Medium body_;
    std::int32_t body_material_;
    bool walking_, leaves_body_;
    int passes_;
    float eta_, next_ior_;    // at the boundary: beyond over here, and of what is entered
    float wave_, next_wave_;  // micrometres; 0: all of them
};

}  // namespace tessera
