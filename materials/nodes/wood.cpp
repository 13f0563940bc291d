#include "materials/nodes/box_filter.h"
#include "materials/nodes/gaussian.h"
#include "materials/nodes/noise.h"
#include "materials/nodes/pattern.h"

namespace tessera {
namespace {

// Darkness across one ring: light earlywood, a parabola up through the latewood, and the sharp end
// of the year.
struct Ring {
    float start, end = 0.95f;

    float dark(float t) const {
        const float s = clamp01((t - start) / (end - start));
        return t < end ? s * s : (1.0f - t) / (1.0f - end);
    }
    float integral(float t) const {
        const float s = clamp01((t - start) / (end - start));
        const float down = std::max(t - end, 0.0f);
        return (end - start) * (1.0f / 3.0f) * s * s * s + down - 0.5f * down * down / (1.0f - end);
    }
};

// The footprint lies at any angle to the rings, so that its shadow on the radius is nearly a tent:
// three boxes, with together the variance of one of width w.
float ring_mean(const Ring& ring, float years, float w) {
    float sum = 0.0f;
    for (int i = -1; i <= 1; ++i)
        sum += periodic_mean(
            years + 0.25f * w * static_cast<float>(i), 0.70710678f * w,
            [&](float t) { return ring.dark(t); }, [&](float t) { return ring.integral(t); });
    return sum * (1.0f / 3.0f);
}

constexpr FractalParams kOne{.octaves = 1};

// Share of the footprint in which a noise exceeds a threshold, with an edge of this variance.
float share_above(Vec3f at, float width, float threshold, float edge) {
    const float n = fractal3d(at, kOne, width), lost = fractal3d_lost(kOne, width);
    return normal_cdf((n - threshold) / std::sqrt(edge + lost));
}

// Flecks along the radius: noise on about a circle and along z, so that there is no seam.
float ray_flecks(Vec3f q, float radius, float w) {
    constexpr float kRays = 40.0f;  // radius of the circle, in rays
    const float scale = kRays / std::max(radius, 1e-3f);
    const float fleck = share_above({q.x * scale, q.y * scale, q.z * 0.4f}, w * scale, 0.2f, 0.01f);
    const float broken = share_above({radius * 0.35f, q.z * 0.22f, 71.5f}, w * 0.35f, 0.0f, 0.02f);
    return fleck * broken;
}

}  // namespace

Wood wood(Vec3f p, const WoodParams& v, float width) noexcept {
    const float unit = 1.0f / within(v.ring_width, 1e-6f, 1e6f);
    const Vec3f q = coordinate(coordinate(p) * unit);
    const float w = footprint(width) * unit;

    // Rings stray slowly across the stem, more slowly along it.
    const FractalParams bends{.octaves = 3, .diminish = 0.4f};
    const Vec3f slow{q.x * 0.05f, q.y * 0.05f, q.z * 0.012f};
    const float far = 4.0f * within(v.distortion, 0.0f, 8.0f);
    const Vec3f bend = far * fractal3d_vec3(slow, bends, w * 0.05f);
    const float radius = std::sqrt(sqr(q.x + bend.x) + sqr(q.y + bend.y));
    const float years = radius + 0.9f * within(v.ring_variation, 0.0f, 1.0f) *
                                     noise2d({radius * 0.45f, 0.37f}, w * 0.45f);
    const float spread = std::sqrt(sqr(w) + 12.0f * sqr(far) * fractal3d_lost(bends, w * 0.05f));
    const Ring ring{0.95f - within(v.latewood, 0.05f, 0.9f)};
    const float dark = ring_mean(ring, years, spread);

    const float grain = within(v.grain, 0.0f, 1.0f);
    const FractalParams fibres{.octaves = 3, .diminish = 0.6f};
    const float fibre = fractal3d({q.x * 5.0f, q.y * 5.0f, q.z * 0.12f}, fibres, w * 5.0f);
    const Vec3f pores{q.x * 11.0f + 7.3f, q.y * 11.0f, q.z * 0.3f};
    const float pore = share_above(pores, w * 11.0f, 0.38f, 0.003f) * (1.0f - 0.7f * dark);
    const float ray = within(v.rays, 0.0f, 1.0f) * ray_flecks(q, radius, w);

    Wood out;
    out.ring = dark;
    const Color tint =
        lerp(v.earlywood, v.latewood_color, clamp01(0.06f + dark + 0.25f * grain * fibre));
    out.color =
        tint * std::max(1.0f + grain * (0.4f * fibre - 0.7f * pore), 0.0f) * (1.0f + 0.35f * ray);
    out.height = clamp01(0.6f + 0.2f * dark + grain * (0.1f * fibre - 0.5f * pore));
    out.roughness =
        std::clamp(0.05f - 0.1f * dark + grain * 0.1f * pore - 0.05f * ray, -0.15f, 0.15f);
    return out;
}

}  // namespace tessera
