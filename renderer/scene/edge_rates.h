#pragma once
// Into how many pieces each edge of a cage is cut.

#include <span>
#include <vector>

#include "renderer/core/affine.h"
#include "renderer/geometry/cage.h"
#include "renderer/scene/camera.h"

namespace tessera {

/// How large things look: of the full frame, whatever part of it is rendered.
struct ViewScale {
    Vec3d eye;              // in the world
    double per_unit = 0;    // pixels that a scene unit covers one unit away, or at any distance
    bool parallel = false;  // an orthographic view
    /// Pixels of a length at a distance.
    double pixels(double length, double distance) const;
};
ViewScale view_scale(const Camera& camera, Vec3d origin);

/// The placement of a cage that looks largest.
const Affined& nearest_placement(const Cage& cage, std::span<const Affined> placements,
                                 const ViewScale& view);

struct EdgeRates {
    std::vector<int> rates;     // per edge, through make_even
    std::uint64_t limited = 0;  // edges that max_rate holds back
};

/// unit: scene units that one unit of the cage comes to. placement: for rates by pixels.
EdgeRates edge_rates(const Cage& cage, const SubdivisionDesc& desc, double unit,
                     const Affined& placement, const ViewScale& view);

}  // namespace tessera
