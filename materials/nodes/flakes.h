#pragma once
// Metal flakes in paint: little mirrors, each tilted its own way.
//
// The tilts are those of GGX microfacets of roughness `spread`, so that flakes too small to be seen
// are a rough metal. As flakes grow smaller than the footprint their mean normal turns to the
// surface's, and what it loses goes to the roughness, as in Toksvig, "Mipmapping Normal Maps", JGT
// 10(3), 2005.

#include "renderer/core/vec.h"

namespace tessera {

struct FlakeParams {
    float size = 0.01f;      // pitch of the flakes, 1e-6 to 1e6
    float coverage = 0.5f;   // share of the surface, 0 to 1
    float spread = 0.4f;     // of the tilts: a roughness, whose square is alpha; 0 to 1
    float roughness = 0.1f;  // of each flake, 0 to 1
};

struct Flakes {
    Vec3f normal{0.0f, 0.0f, 1.0f};  // unit, in the space of n
    float mask = 0.0f;               // share that is flake
    float random = 0.5f;             // in [0, 1), for each flake
    float roughness = 0.0f;          // each flake's own, and of the tilts that the normal lost
};

/// At a point of a surface with the normal n; without a length it counts as z. `width` and what p
/// may be are those of pattern.h.
Flakes flakes(Vec3f p, Vec3f n, const FlakeParams& f, float width) noexcept;

}  // namespace tessera
