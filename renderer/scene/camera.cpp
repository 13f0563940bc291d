#include "renderer/scene/camera.h"

#include <cmath>

#include "renderer/core/affine.h"
#include "renderer/core/warp.h"

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;

struct Placed {
    Vec3d position, right, up, forward;
    double to_target = 0;  // 0: unknown
};

Placed look_at(Vec3d position, Vec3d target, Vec3d up_hint, const SourceLoc& loc) {
    const Vec3d d = target - position;
    const double distance = length(d);
    if (!(distance > 0))
        throw Error(ExitCode::scene, loc,
                    "camera: position and look_at are the same point, they must differ");
    const Vec3d forward = d / distance;
    Vec3d right = cross(forward, up_hint);
    if (!(length(right) > 1e-9 * length(up_hint))) {
        // Looking along 'up': any upright will do.
        right = cross(forward, std::abs(forward.z) < 0.9 ? Vec3d{0, 0, -1} : Vec3d{1, 0, 0});
    }
    right = normalize(right);
    return {position, right, cross(right, forward), forward, distance};
}

// A three-quarter view from the front, a little from the right and above, from which every corner
// of the bounds is just inside the frame.
Placed frame_bounds(Vec3d lo, Vec3d hi, double tan_x, double tan_y, bool orthographic) {
    constexpr double kMargin = 1.06;
    const Vec3d center = (lo + hi) * 0.5;
    const double radius = std::max(length(hi - lo) * 0.5, 1e-6);
    const Vec3d from = normalize(Vec3d{0.55, 0.38, 1.0});
    Placed c = look_at(center + from, center, {0, 1, 0}, {});
    double distance = orthographic ? 3 * radius : 1.02 * radius;
    for (int corner = 0; corner < 8 && !orthographic; ++corner) {
        const Vec3d q =
            Vec3d{corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z} -
            center;
        const double across =
            std::max(std::abs(dot(q, c.right)) / tan_x, std::abs(dot(q, c.up)) / tan_y);
        distance = std::max(distance, kMargin * across - dot(q, c.forward));
    }
    c.position = center + from * distance;
    c.to_target = distance;
    return c;
}

}  // namespace

Camera::Camera(const CameraDesc& desc, int width, int height, Vec3d origin, Vec3d bounds_min,
               Vec3d bounds_max) {
    orthographic_ = desc.projection == Projection::orthographic;
    const double aspect = static_cast<double>(width) / height;
    const double tan_asked = std::tan(0.5 * desc.fov_deg * kPiD / 180);
    const double tan_v = desc.fov_axis == FovAxis::vertical ? tan_asked : tan_asked / aspect;

    Placed c;
    double half_height = 0.5 * desc.ortho_height;
    if (desc.matrix) {
        const Affined m = affine_from_rows(*desc.matrix);
        if (!(length(m.x) > 0 && length(m.y) > 0 && length(m.z) > 0)) {
            throw Error(ExitCode::scene, desc.loc, "camera: the matrix has a zero column");
        }
        c = {m.p - origin, normalize(m.x), normalize(m.y), normalize(-m.z), 0};
    } else if (desc.automatic) {
        c = frame_bounds(bounds_min, bounds_max, tan_v * aspect, tan_v, orthographic_);
        if (orthographic_)
            half_height = 0.5 * length(bounds_max - bounds_min) / std::min(1.0, aspect);
    } else {
        c = look_at(Vec3d(desc.position) - origin, Vec3d(desc.look_at) - origin, Vec3d(desc.up),
                    desc.loc);
    }
    if (!orthographic_) half_height = tan_v;
    position_ = Vec3f(c.position);
    forward_ = Vec3f(c.forward);
    right_ = Vec3f(c.right * (half_height * aspect));
    up_ = Vec3f(c.up * half_height);
    to_x_ = static_cast<float>(2.0 / width);
    to_y_ = static_cast<float>(2.0 / height);
    aperture_ = static_cast<float>(desc.aperture_radius);
    const double focus = desc.focus_distance > 0 ? desc.focus_distance : c.to_target;
    if (aperture_ > 0.0f && !(focus > 0)) {
        throw Error(ExitCode::scene, desc.loc,
                    "camera: aperture_radius needs a focus_distance when the camera is a matrix");
    }
    focus_ = static_cast<float>(focus > 0 ? focus : 1);
    const double pixel = 2 * half_height / height;
    (orthographic_ ? footprint_ : spread_) = static_cast<float>(pixel);
}

CameraRay Camera::ray(Vec2f film, Vec2f lens) const noexcept {
    const Vec3f across = right_ * (film.x * to_x_ - 1.0f) + up_ * (1.0f - film.y * to_y_);
    CameraRay r;
    r.cone_width = footprint_;
    r.cone_spread = spread_;
    r.ray.mask = kCameraRays;
    if (orthographic_) {
        r.ray.o = position_ + across;
        r.ray.d = forward_;
        return r;
    }
    const Vec3f through = forward_ + across;
    r.ray.o = position_;
    r.ray.d = normalize(through);
    if (aperture_ > 0.0f) {
        const Vec2f d = warp_disc_concentric(lens);
        const Vec3f shift =
            normalize(right_) * (d.x * aperture_) + normalize(up_) * (d.y * aperture_);
        r.ray.o = position_ + shift;
        r.ray.d = normalize(through * focus_ - shift);
        // The circle of confusion is the footprint that textures need.
        r.cone_width = 2.0f * aperture_ * 0.1f;
    }
    return r;
}

}  // namespace tessera
