#pragma once
// Where the light ends on a bumpy surface.

#include <algorithm>

#include "renderer/core/vec.h"

namespace tessera {

/// Share of the light from wi that a diffuse surface is given (both vectors local to the shading
/// frame): 1 in the open, and smoothly to 0 where wi sinks behind the surface without its bumps,
/// whose normal is `even`; it would else end in a hard edge. Chiang, Li, Burley, "Taming the Shadow
/// Terminator", SIGGRAPH 2019 Talks, eq. 1-3.
inline float softened_terminator(Vec3f even, Vec3f wi) {
    const float open = std::max(wi.z * even.z, 1e-6f);
    const float g = std::clamp(dot(even, wi) / open, 0.0f, 1.0f);
    return g * (1.0f + g * (1.0f - g));
}

}  // namespace tessera
