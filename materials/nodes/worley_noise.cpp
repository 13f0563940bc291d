#include "materials/nodes/lattice.h"
#include "materials/nodes/nearest_points.h"
#include "materials/nodes/noise.h"

namespace tessera {
namespace {

// Mean of a distance over the plane or space, by jitter j: a parabola in j^2 through measured
// values.
struct Means {
    float regular, linear, square;
    float at(float jitter) const {
        const float j2 = sqr(jitter);
        return regular + j2 * (linear + j2 * square);
    }
};
// Widths at which the distances and the value are gone: fitted like those of noise.cpp, at
// jitter 1.
struct Fades {
    Means mean1, mean2, mean3;
    float f1, f2, f3, value;
};

float faded(float distance, float mean, float kept) { return mean + (distance - mean) * kept; }

Worley filtered(const NearestPoints& n, float jitter, float w, const Fades& fades) {
    Worley out{std::sqrt(n.d1), std::sqrt(n.d2), unit_float(hash_u32(n.id1)), n.id1};
    if (w == 0.0f) return out;
    out.f1 = faded(out.f1, fades.mean1.at(jitter), fade_out(w, fades.f1));
    out.f2 = faded(out.f2, fades.mean2.at(jitter), fade_out(w, fades.f2));
    // Across the border the other's value comes in.
    const float own = n.own_share(w);
    const float other = unit_float(hash_u32(n.id2));
    out.value = faded(out.value * own + other * (1.0f - own), 0.5f, fade_out(w, fades.value));
    return out;
}

Vec3f filtered_three(const NearestPoints& n, float jitter, float w, const Fades& fades) {
    const Vec3f d{std::sqrt(n.d1), std::sqrt(n.d2), std::sqrt(n.d3)};
    if (w == 0.0f) return d;
    return {faded(d.x, fades.mean1.at(jitter), fade_out(w, fades.f1)),
            faded(d.y, fades.mean2.at(jitter), fade_out(w, fades.f2)),
            faded(d.z, fades.mean3.at(jitter), fade_out(w, fades.f3))};
}

constexpr Fades kFades2d{{0.3827f, 0.0538f, -0.0071f},
                         {0.6994f, 0.0126f, -0.0132f},
                         {0.9081f, -0.0420f, 0.0288f},
                         2.2f,
                         2.6f,
                         2.75f,
                         4.9f};
constexpr Fades kFades3d{{0.4807f, 0.0469f, -0.0067f},
                         {0.7027f, 0.0431f, -0.0285f},
                         {0.8630f, -0.0550f, 0.0375f},
                         2.5f,
                         2.7f,
                         2.75f,
                         4.6f};

}  // namespace

Worley worleynoise2d(Vec2f p, float jitter, float width) noexcept {
    if (is_nan(p)) return {};
    const float j = within(jitter, 0.0f, 1.0f);
    return filtered(nearest_points(p, j), j, footprint(width), kFades2d);
}

Worley worleynoise3d(Vec3f p, float jitter, float width) noexcept {
    if (is_nan(p)) return {};
    const float j = within(jitter, 0.0f, 1.0f);
    return filtered(nearest_points(p, j), j, footprint(width), kFades3d);
}

Vec3f worleynoise2d_vec3(Vec2f p, float jitter, float width) noexcept {
    if (is_nan(p)) return {};
    const float j = within(jitter, 0.0f, 1.0f);
    return filtered_three(nearest_three(p, j), j, footprint(width), kFades2d);
}

Vec3f worleynoise3d_vec3(Vec3f p, float jitter, float width) noexcept {
    if (is_nan(p)) return {};
    const float j = within(jitter, 0.0f, 1.0f);
    return filtered_three(nearest_three(p, j), j, footprint(width), kFades3d);
}

}  // namespace tessera
