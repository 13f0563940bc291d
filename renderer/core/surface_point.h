#pragma once
// Where a ray met a surface: all that shading asks of geometry.

#include <cstdint>

#include "renderer/core/frame.h"
#include "renderer/core/vec.h"

namespace tessera {

struct SurfacePoint {
    Vec3f p;           // from the primitive's own vertices, not from the ray
    Vec3f p_error;     // bound on its rounding error, per axis
    Vec3f ng;          // unit, outward by the winding
    Vec3f ns;          // unit shading normal, on ng's side
    Vec3f lift;        // from p to the surface that smooth normals pretend; zero unless outward
    Vec3f dpdu, dpdv;  // along u and v (not unit); zero if there are no uvs
    Vec2f uv;
    float handed = 1;         // -1 where the uv chart is mirrored
    float uv_per_length = 0;  // uv units per scene unit on the surface, for texture footprints
    Color vertex_color{1.0f};
    std::int32_t material = -1;
    std::uint32_t placement = 0;
    std::uint32_t face = 0;  // of the mesh; 0 for spheres and discs
    std::int32_t light = -1;
};

}  // namespace tessera
