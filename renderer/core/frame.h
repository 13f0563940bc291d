#pragma once
// Orthonormal frame around a unit normal.
// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.

#include <cmath>

#include "renderer/core/vec.h"

namespace tessera {

struct Frame {
    Vec3f s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    Frame() = default;
    Frame(Vec3f s_, Vec3f t_, Vec3f n_) : s(s_), t(t_), n(n_) {}
    explicit Frame(Vec3f normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        t = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3f to_local(Vec3f v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
    Vec3f to_world(Vec3f v) const { return s * v.x + t * v.y + n * v.z; }
};

/// Frame whose s axis lies as near to `tangent` as it can; any frame if the two are parallel.
inline Frame frame_along(Vec3f normal, Vec3f tangent) {
    const Vec3f s = tangent - normal * dot(normal, tangent);
    const float l2 = length2(s);
    if (!(l2 > 1e-20f) || !std::isfinite(l2)) return Frame(normal);
    const Vec3f unit = s / std::sqrt(l2);
    return {unit, cross(normal, unit), normal};
}

}  // namespace tessera
