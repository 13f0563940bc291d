#pragma once
// What every lobe agrees on. Directions are unit, point away from the surface, and live in the
// local frame (z = shading normal) with wo.z > 0. Values include the cosine: f = bsdf * |wi.z|.
// Pdfs are per solid angle.

#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

/// How a lobe counts for the depth limits and the passes.
enum class LobeClass : std::uint8_t { diffuse, glossy, transmission };

struct LobeEval {
    Color f{0.0f};
    float pdf = 0;
};

/// Lobes have eval(wo, wi), sample(wo, u, choice, out), albedo(wo), and, unless they are deltas,
/// direction(): sample() without weight and pdf, for when those of several lobes together are
/// wanted. Samples are filled in where they are kept (an optional that is copied cost more than its
/// making); false: there is none.
struct LobeSample {
    Vec3f wi;
    Color weight;   // f / pdf; for a delta lobe the whole ratio
    float pdf = 0;  // 0 for a delta lobe
    LobeClass cls = LobeClass::diffuse;
    bool delta = false;
    float eta = 1;     // index on wi's side over wo's side; 1 unless refracted
    float spread = 0;  // half angle by which a ray cone grows, radians, rough
};

/// A lobe's sample by its direction() and eval().
template <class Lobe>
bool sample_by_eval(const Lobe& lobe, Vec3f wo, Vec2f u, float choice, LobeSample& out) {
    if (!lobe.direction(wo, u, choice, out)) return false;
    const LobeEval e = lobe.eval(wo, out.wi);
    if (!(e.pdf > 0.0f)) return false;
    out.weight = e.f / e.pdf;
    out.pdf = e.pdf;
    return true;
}

/// Relative luminance of linear Rec.709; near enough for choosing lobes and lights in any working
/// space.
constexpr float luminance(Color c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

}  // namespace tessera
