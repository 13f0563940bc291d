#pragma once
// Small questions that placing shapes asks, in double precision.

#include "renderer/api/scene_desc.h"
#include "renderer/core/affine.h"
#include "renderer/scene/flatten.h"

namespace tessera {

struct Bounds {
    Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
    bool empty() const { return lo.x > hi.x; }
    void add(Vec3d p) { lo = min(lo, p), hi = max(hi, p); }
    void add(const Bounds& b) {
        if (!b.empty()) add(b.lo), add(b.hi);
    }
};

/// How often a shape stands, and what was made of it.
struct ShapeUse {
    int count = 0;
    int shape = -1;
    bool cutout_override = false;
    float crease_angle_deg = kInfinity;  // asked for by instances' own materials
    Vec3d own_origin;
};

Bounds instance_bounds(const SceneDesc& desc, const FlatInstance& instance);
Bounds light_bounds(const LightDesc& light);
Vec3d mesh_center(const MeshDesc& mesh);
/// Rotation, mirror and one scale: a sphere stays a sphere.
bool is_similarity(const Affined& m);
/// One positive scale and nothing else (but the translation).
bool is_scaling(const Affined& m);

}  // namespace tessera
