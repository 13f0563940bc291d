#include "materials/nodes/gaussian.h"
#include "materials/nodes/lattice.h"
#include "materials/nodes/noise.h"
#include "materials/nodes/pattern.h"

namespace tessera {
namespace {

// Veins are where a bent fractal sum crosses zero: sheets through the stone.
struct Veins {
    float scale, shift;
    float thickness;
    FractalParams noise;
};

float veins_at(Vec3f q, float w, const Veins& v) {
    const Vec3f at = q * v.scale + Vec3f(v.shift);
    const float width = w * v.scale;
    return mean_bump(fractal3d(at, v.noise, width), fractal3d_lost(v.noise, width), v.thickness);
}

// Share of the footprint in which a fractal sum exceeds a threshold; the edge has
// this variance.
float share_above(Vec3f at, float w, const FractalParams& f, float threshold, float edge) {
    return normal_cdf((fractal3d(at, f, w) - threshold) / std::sqrt(edge + fractal3d_lost(f, w)));
}

}  // namespace

Marble marble(Vec3f p, const MarbleParams& m, float width) noexcept {
    const float frequency = within(m.frequency, 1e-6f, 1e6f);
    const Vec3f q = coordinate(p) * frequency;
    const float w = footprint(width) * frequency;

    const FractalParams bends{.octaves = 5, .diminish = 0.5f};
    const float bend = 0.6f * within(m.turbulence, 0.0f, 8.0f);
    const Vec3f bent = q + bend * fractal3d_vec3(q * 0.7f, bends, w * 0.7f);
    // What bending no longer resolves spreads the points of the footprint further apart.
    const float spread = std::sqrt(sqr(w) + 12.0f * sqr(bend) * fractal3d_lost(bends, w * 0.7f));

    const float fine = 1.0f - within(m.sharpness, 0.0f, 1.0f);
    const float thin = 0.012f + 0.12f * sqr(fine);
    const float major = veins_at(bent, spread, {0.55f, 3.1f, thin, {.octaves = 2}});
    const float minor = veins_at(bent, spread, {1.7f, 17.9f, 0.6f * thin, {.octaves = 3}});

    const float cloud = share_above(bent * 0.6f + Vec3f(51.3f), spread * 0.6f,
                                    {.octaves = 5, .diminish = 0.6f}, 0.12f, 0.1f);
    // Where the great veins are strong the small ones are not.
    const Vec3f region = bent * 0.4f + Vec3f(87.7f);
    const FractalParams regions{.octaves = 2};
    const float strong = share_above(region, spread * 0.4f, regions, -0.25f, 0.1f);
    const float weak = share_above(-region, spread * 0.4f, regions, 0.1f, 0.04f);

    Marble out;
    out.vein = clamp01(major * strong + 0.7f * minor * weak) * within(m.veins, 0.0f, 1.0f);
    const Color stone = lerp(m.base, m.cloud, cloud);
    out.color = lerp(stone, m.vein, out.vein);
    return out;
}

}  // namespace tessera
