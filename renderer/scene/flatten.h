#pragma once
// Groups and instances to a flat list of placed shapes, in double precision.

#include <vector>

#include "renderer/api/scene_desc.h"
#include "renderer/core/affine.h"

namespace tessera {

struct FlatInstance {
    ShapeKind kind = ShapeKind::mesh;  // never group
    int index = -1;
    Affined to_world;
    int material = -1;
    std::uint32_t outermost = 0;  // of SceneDesc::instances, that it comes from
};

/// In file order. Singular and non-finite transforms are left out with a warning; a group inside
/// itself is an error.
std::vector<FlatInstance> flatten(const SceneDesc& desc, Problems& problems);

}  // namespace tessera
