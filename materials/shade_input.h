#pragma once
// What a shader program may ask of the point it shades.

#include <cstdint>

#include "renderer/core/affine.h"
#include "renderer/core/crease_tree.h"
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
    Vec3f view{0, 0, -1};     // from the viewer, unit
    float facing = 1;         // |cosine| to the viewer
    bool front = true;        // seen from where the faces' winding has the front
    float object_scale = 1;   // object units in a scene unit
    // Hashes of names, and of which copy of an instance it is.
    std::uint32_t instance = 0, instance_name = 0, object_name = 0, material_name = 0;
    const CreaseTree* creases = nullptr;  // of the object, for programs that ask for them
    const Affinef* to_object = nullptr;   // from the scene; null: that is the object's space
    // And those that say `tangent`:
    Vec3f dpdu, dpdv;  // in the world; zero if there are no texture coordinates
    float handed = 1;  // -1 where the uv chart is mirrored
};

}  // namespace tessera
