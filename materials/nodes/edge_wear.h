#pragma once
// Wear along convex edges, by the distance to the nearest one.

#include "renderer/core/crease_tree.h"

namespace tessera {

struct EdgeWearParams {
    float width = 0.02f;      // how far from the edge wear ends
    float angle_deg = 30.0f;  // of the faces that meet there, at least
    float contrast = 1.0f;    // 1 smooth, above: bare, with a harder and harder rim; 1 to 1000
};

/// 1 on an edge, 0 `width` from it; the mean over a footprint. `front`: the point is looked at from
/// the side that the faces' winding calls the front.
float edge_wear(const CreaseTree& creases, Vec3f p, const EdgeWearParams& e, float footprint,
                bool front) noexcept;

}  // namespace tessera
