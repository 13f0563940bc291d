#pragma once
// What every lobe agrees on. Directions are unit, point away from the surface, and live in the
// local frame (z = shading normal) with wo.z > 0. Values include the cosine: f = bsdf * |wi.z|.
// Pdfs are per solid angle.

#include <cstdint>

#include "renderer/core/ray.h"
#include "renderer/core/vec.h"

namespace tessera {

/// How a lobe counts for the depth limits and the passes.
enum class LobeClass : std::uint8_t { diffuse, glossy, transmission, subsurface };

struct LobeEval {
    Color f{0.0f};
    float pdf = 0;
};

/// Where a lobe sends a path. wi is zero when it sends it nowhere.
struct LobeDirection {
    Vec3f wi;
    float eta = 1;  // index on wi's side over wo's side; 1 unless refracted
    LobeClass cls = LobeClass::diffuse;
};

/// A direction of a smooth lobe with its whole ratio of f over pdf.
struct SmoothSample {
    LobeDirection to;
    Color weight;
};

/// A lobe is a plain struct, the same for every surface point of its kind:
///  - kDelta: it is smooth, all in one or two directions;
///  - Lanes: its parameters for sixteen points, by components, with set(lane, lobe) and get(lane);
///  - albedo(wo): the share of light it sends back, roughly, for choosing among lobes;
///  - extended lobes: eval(wo, wi) and direction(wo, u, choice), without branches: they run for
///    sixteen lanes at once; spread(): the half angle by which a ray cone grows, radians, rough;
///  - smooth lobes: sample(wo, u, choice), and branch(wo, child), which calls child(SmoothSample)
///  for
///    each of their directions: the children of a ray tree.

/// Relative luminance of linear Rec.709; near enough for choosing lobes and lights in any working
/// space.
constexpr float luminance(Color c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

}  // namespace tessera
