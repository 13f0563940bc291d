#pragma once
// What a shader program may ask of the point it shades.

#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

struct ShadeInput {
    Vec2f uv;
    float uv_width = 0;  // footprint in uv units
    Color vertex_color{1.0f};
    std::uint32_t seed = 0;  // for filters that draw a texel
    // For programs whose facts say `geometry`:
    Vec3f p_object, p_world;  // in the object's own coordinates, and in the world's
    Vec3f n;                  // shading normal, world
    float p_width = 0;        // footprint on the surface, scene units
    float facing = 1;         // |cosine| to the viewer
    std::uint32_t instance = 0;
};

}  // namespace tessera
