#pragma once
// A described mesh to the floats that are traced: moved, split into parts, cleaned.

#include <functional>

#include "renderer/api/scene_desc.h"
#include "renderer/core/affine.h"
#include "renderer/geometry/shapes.h"

namespace tessera {

struct BakeNeeds {
    bool uvs = true;
    bool colors = true;
    bool objects = true;
    std::function<bool(int material)> cutout;  // does this material (scene index) cut holes
    bool any_cutout_override = false;          // an instance's own material does
};

struct BakeReport {
    std::size_t degenerate = 0;                       // faces whose area is zero in float
    std::size_t dropped_uvs = 0, dropped_colors = 0;  // bytes not kept because nothing reads them
};

/// positions' = float(place.point(position)); place carries the transform and the new origin. A
/// mirrored place turns the winding, so that normals stay outside.
Mesh bake_mesh(const MeshDesc& desc, const Affined& place, const BakeNeeds& needs,
               BakeReport& report);

}  // namespace tessera
