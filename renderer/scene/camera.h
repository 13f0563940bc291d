#pragma once
// From a point on the film to a ray. In the scene's own space.

#include "renderer/api/scene_desc.h"
#include "renderer/core/ray.h"
#include "renderer/core/sampler.h"

namespace tessera {

class Camera {
public:
    Camera() = default;
    /// origin: where the scene's own space lies in the world. bounds: of the scene, for automatic
    /// framing, in the scene's space. Throws Error for a camera that cannot be.
    Camera(const CameraDesc& desc, int width, int height, Vec3d origin, Vec3d bounds_min,
           Vec3d bounds_max);

    /// film: pixels, y downward, (0, 0) the top left corner, for a block of 4x4 pixels from column
    /// x on. lens: unit square, read only if has_lens(). Fills in origins, directions, t_max and
    /// masks of all lanes.
    void rays(const SamplePairs& film, const SamplePairs& lens, const int (&x)[kLanes],
              RayPacket& out) const noexcept;
    /// A ray's footprint at its origin, scene units, and the full angle by which it grows, radians.
    float cone_width() const noexcept { return footprint_; }
    float cone_spread() const noexcept { return spread_; }
    bool has_lens() const noexcept { return aperture_ > 0.0f; }
    Vec3f position() const noexcept { return position_; }
    /// Of a point: along the axis, or the distance where the picture shows all directions.
    float depth(Vec3f p) const noexcept {
        return shows_all_directions(projection_) ? length(p - position_)
                                                 : dot(p - position_, forward_);
    }

private:
    void place_all_around(const CameraDesc& desc, int width, int height, Vec3d origin,
                          Vec3d center);
    void all_around(const SamplePairs& film, const int (&x)[kLanes], RayPacket& out) const noexcept;

    Vec3f position_, right_, up_,
        forward_;  // right_ and up_ scaled to half the film at distance 1 (or in units)
    Vec3f lens_right_, lens_up_;  // of the aperture's length
    float to_x_ = 0, to_y_ = 0;   // 2 / resolution
    float aperture_ = 0, focus_ = 1, spread_ = 0, footprint_ = 0;
    int face_px_ = 1;  // side of a cube's face
    Projection projection_ = Projection::perspective;
};

}  // namespace tessera
