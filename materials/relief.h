#pragma once
// Normals that maps and heights make of a surface's own.

#include <algorithm>
#include <cmath>

#include "materials/shade_input.h"
#include "renderer/core/frame.h"

namespace tessera {

/// in.n as it looks outward.
inline Vec3f outward_normal(const ShadeInput& in) { return in.front ? in.n : -in.n; }

/// A normal of the tangent frame (x along u, y along v, z out) in the world, on in.n's side.
inline Vec3f normal_from_tangent_space(const ShadeInput& in, Vec3f local) {
    const Frame base = frame_along(outward_normal(in), in.dpdu);
    const Vec3f n = normalize(base.to_world({local.x, local.y * in.handed, local.z}));
    return in.front ? n : -n;
}

/// What a normal map's texel, 0 to 1, stands for.
inline Vec3f unpacked_normal(Vec3f texel, float scale) {
    return normalize(Vec3f{(2.0f * texel.x - 1.0f) * scale, (2.0f * texel.y - 1.0f) * scale,
                           std::max(2.0f * texel.z - 1.0f, 1e-3f)});
}

/// The point moved along the surface, by a length in the world and what that is in uv.
inline ShadeInput moved(ShadeInput in, Vec3f by, Vec2f uv) {
    in.p_world += by;
    in.p_object += in.to_object ? in.to_object->vector(by) : by;
    in.uv = in.uv + uv;
    return in;
}

/// What the object's unit comes to in the world, along the normal.
inline float object_unit(const ShadeInput& in) {
    return in.to_object ? 1.0f / length(in.to_object->vector(in.n)) : 1.0f;
}

/// The length in the world over which u or v grow by one.
inline float texture_unit(const ShadeInput& in) {
    return in.uv_width > 0.0f ? in.p_width / in.uv_width : 0.0f;
}

/// n (on in.n's side) tilted by a height that varies over the surface; `unit` is what a height of
/// one comes to in the world. height(ShadeInput) is asked at three points half a footprint apart.
/// Mikkelsen, "Bump Mapping Unparametrized Surfaces on the GPU", 2010.
template <class Height>
Vec3f bumped_normal(Vec3f n, const ShadeInput& in, float unit, Height height) {
    const Vec3f out = in.front ? n : -n;
    Vec3f t = in.dpdu, b = in.dpdv;
    float lt = length(t), lb = length(b);
    const bool charted = length2(cross(t, b)) > 1e-12f * lt * lt * lb * lb;
    if (!charted) {
        const Frame any(out);
        t = any.s, b = any.t, lt = lb = 1.0f;
    }
    t *= 1.0f / lt;
    b *= 1.0f / lb;
    const float step = std::max(0.5f * in.p_width, 1e-5f * max_component(abs(in.p_world)) + 1e-9f);
    const float du = charted ? step / lt : 0.0f, dv = charted ? step / lb : 0.0f;
    const float h = height(in), along_t = height(moved(in, t * step, {du, 0.0f})) - h,
                along_b = height(moved(in, b * step, {0.0f, dv})) - h;
    const float k = unit / (step * dot(out, cross(t, b)));
    const Vec3f tilted = normalize(out - (cross(b, out) * along_t + cross(out, t) * along_b) * k);
    if (!(length2(tilted) < 2.0f)) return n;
    return in.front ? tilted : -tilted;
}

}  // namespace tessera
