#include "renderer/scene/camera.h"

#include <cmath>

#include <fmt/format.h>

#include "renderer/core/affine.h"
#include "renderer/core/warp.h"
#include "renderer/lights/map_projection.h"

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
    projection_ = desc.projection;
    to_x_ = static_cast<float>(2.0 / width);
    to_y_ = static_cast<float>(2.0 / height);
    if (shows_all_directions(projection_)) {
        place_all_around(desc, width, height, origin, (bounds_min + bounds_max) * 0.5);
        return;
    }
    const bool orthographic = projection_ == Projection::orthographic;
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
        c = frame_bounds(bounds_min, bounds_max, tan_v * aspect, tan_v, orthographic);
        if (orthographic)
            half_height = 0.5 * length(bounds_max - bounds_min) / std::min(1.0, aspect);
    } else {
        c = look_at(Vec3d(desc.position) - origin, Vec3d(desc.look_at) - origin, Vec3d(desc.up),
                    desc.loc);
    }
    if (!orthographic) half_height = tan_v;
    position_ = Vec3f(c.position);
    forward_ = Vec3f(c.forward);
    right_ = Vec3f(c.right * (half_height * aspect));
    up_ = Vec3f(c.up * half_height);
    aperture_ = static_cast<float>(desc.aperture_radius);
    const double focus = desc.focus_distance > 0 ? desc.focus_distance : c.to_target;
    if (aperture_ > 0.0f && !(focus > 0)) {
        throw Error(ExitCode::scene, desc.loc,
                    "camera: aperture_radius needs a focus_distance when the camera is a matrix");
    }
    focus_ = static_cast<float>(focus > 0 ? focus : 1);
    lens_right_ = Vec3f(c.right * static_cast<double>(aperture_));
    lens_up_ = Vec3f(c.up * static_cast<double>(aperture_));
    const double pixel = 2 * half_height / height;
    (orthographic ? footprint_ : spread_) = static_cast<float>(pixel);
    // The circle of confusion is the footprint that textures need.
    if (has_lens() && !orthographic) footprint_ = 0.2f * aperture_;
}

// The lens has no say, and where the camera looks has none either: the map's axes are the world's.
void Camera::place_all_around(const CameraDesc& desc, int width, int height, Vec3d origin,
                              Vec3d center) {
    if (projection_ == Projection::cube && width != 6 * std::int64_t{height}) {
        throw Error(ExitCode::scene, desc.loc,
                    fmt::format("camera: a cube is six squares side by side, the resolution is "
                                "{}x{}, must be 6:1",
                                width, height));
    }
    position_ = Vec3f(center);
    if (desc.matrix) {
        position_ = Vec3f(affine_from_rows(*desc.matrix).p - origin);
    } else if (!desc.automatic) {
        position_ = Vec3f(Vec3d(desc.position) - origin);
    }
    face_px_ = height;
    spread_ = static_cast<float>((projection_ == Projection::cube ? 2 : kPiD) / height);
}

// A pixel's samples beyond an edge of its face go on in the face's plane: the strip's neighbours
// are not the cube's.
void Camera::all_around(const SamplePairs& film, const int (&x)[kLanes],
                        RayPacket& out) const noexcept {
    for (int i = 0; i < kLanes; ++i) {
        Vec3f d;
        if (projection_ == Projection::latlong) {
            d = latlong_direction({0.5f * to_x_ * film.x[i], 0.5f * to_y_ * film.y[i]});
        } else {
            const int number = std::min(x[i] / face_px_, 5);
            const FaceFrame& face = face_frame(CubeFaces::opengl, number);
            const float column = film.x[i] - static_cast<float>(number * face_px_);
            d = normalize(Vec3f(face.forward) + Vec3f(face.right) * (column * to_y_ - 1.0f) +
                          Vec3f(face.down) * (film.y[i] * to_y_ - 1.0f));
        }
        out.set(i, {position_, d, kInfinity, kCameraRays});
    }
}

void Camera::rays(const SamplePairs& film, const SamplePairs& lens, const int (&x)[kLanes],
                  RayPacket& out) const noexcept {
    if (shows_all_directions(projection_)) return all_around(film, x, out);
    const bool orthographic = projection_ == Projection::orthographic;
    // One loop per kind of camera: each is vectorised.
    for (int i = 0; i < kLanes; ++i) {
        const Vec3f across = right_ * (film.x[i] * to_x_ - 1.0f) + up_ * (1.0f - film.y[i] * to_y_);
        const Vec3f o = orthographic ? position_ + across : position_;
        const Vec3f d = orthographic ? forward_ : normalize(forward_ + across);
        out.ox[i] = o.x, out.oy[i] = o.y, out.oz[i] = o.z;
        out.dx[i] = d.x, out.dy[i] = d.y, out.dz[i] = d.z;
        out.t_min[i] = 0.0f, out.t_max[i] = kInfinity, out.time[i] = 0.0f;
        out.mask[i] = kCameraRays, out.id[i] = static_cast<std::uint32_t>(i), out.flags[i] = 0;
    }
    if (!has_lens() || orthographic) return;
    for (int i = 0; i < kLanes; ++i) {
        const Vec3f through =
            forward_ + right_ * (film.x[i] * to_x_ - 1.0f) + up_ * (1.0f - film.y[i] * to_y_);
        const Vec2f p = warp_disc_concentric(lens.at(i));
        const Vec3f shift = lens_right_ * p.x + lens_up_ * p.y;
        const Vec3f o = position_ + shift, d = normalize(through * focus_ - shift);
        out.ox[i] = o.x, out.oy[i] = o.y, out.oz[i] = o.z;
        out.dx[i] = d.x, out.dy[i] = d.y, out.dz[i] = d.z;
    }
}

}  // namespace tessera
