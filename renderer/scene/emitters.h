#pragma once
// Lights of a scene: the described ones, their bodies as geometry, emissive surfaces, the
// environment.

#include <span>

#include "materials/program.h"
#include "renderer/geometry/shapes.h"
#include "renderer/image/colour_space.h"
#include "renderer/lights/light_set.h"
#include "renderer/scene/light_tags.h"

namespace tessera {

struct EmitterInput {
    const SceneDesc& desc;
    Vec3d origin, bounds_min, bounds_max;
    std::span<const ShaderProgram> programs;
    const TextureStore* textures;
    const ColorSpaces* colors;  // only for an environment image
    LightTags& tags;
    Problems& problems;
};

/// Adds the bodies of area lights to geometry and sets Placement::light of everything that emits.
LightSet make_emitters(const EmitterInput& in, Geometry& geometry);

}  // namespace tessera
