#include "renderer/lights/spherical_rectangle.h"

#include <algorithm>

#include "renderer/core/fast_math.h"

namespace tessera {

SphericalRectangle::SphericalRectangle(Vec3f corner, Vec3f x_, Vec3f y_, Vec3f z_, float lx,
                                       float ly, Vec3f o_)
    : o(o_), x(x_), y(y_), z(z_) {
    const Vec3f d = corner - o;
    z0 = dot(d, z);
    if (z0 > 0.0f) {
        z = -z;
        z0 = -z0;
    }
    x0 = dot(d, x), y0 = dot(d, y), x1 = x0 + lx, y1 = y0 + ly;
    // Normals of the four planes through o and an edge: only their z and one more component are not
    // zero.
    const float n0 = -y0 / std::sqrt(z0 * z0 + y0 * y0), n1 = x1 / std::sqrt(z0 * z0 + x1 * x1);
    const float n2 = y1 / std::sqrt(z0 * z0 + y1 * y1), n3 = -x0 / std::sqrt(z0 * z0 + x0 * x0);
    const float g0 = acos_poly(-n0 * n1), g1 = acos_poly(-n1 * n2), g2 = acos_poly(-n2 * n3),
                g3 = acos_poly(-n3 * n0);
    b0 = n0;
    b1 = n2;
    k = 2.0f * kPi - g2 - g3;
    solid_angle = g0 + g1 - k;
}

Vec3f SphericalRectangle::sample(Vec2f u) const {
    const float au = u.x * solid_angle + k;
    const SinCos a = sincos_turn(std::clamp(au * (0.5f * kInvPi), 0.0f, 1.0f));
    const float fu = (a.cos * b0 - b1) / a.sin;
    const float cu =
        std::clamp(std::copysign(1.0f / std::sqrt(fu * fu + b0 * b0), fu), -1.0f, 1.0f);
    const float xu = std::clamp(-(cu * z0) / std::max(safe_sqrt(1.0f - cu * cu), 1e-7f), x0, x1);
    const float d2 = xu * xu + z0 * z0;
    const float h0 = y0 / std::sqrt(d2 + y0 * y0), h1 = y1 / std::sqrt(d2 + y1 * y1);
    const float hv = h0 + u.y * (h1 - h0), hv2 = hv * hv;
    const float yv = hv2 < 1.0f - 1e-6f ? hv * std::sqrt(d2) / std::sqrt(1.0f - hv2) : y1;
    return o + x * xu + y * std::clamp(yv, y0, y1) + z * z0;
}

}  // namespace tessera
