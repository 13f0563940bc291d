#include "materials/nodes/gaussian.h"
#include "materials/nodes/lattice.h"
#include "materials/nodes/noise.h"
#include "materials/nodes/pattern.h"

namespace tessera {

// Patches are where a fractal sum exceeds a threshold. The sum is about normally distributed, so
// that the threshold follows from the share that is to be rusted; what a footprint takes from the
// sum's variance widens the threshold instead, which keeps that share.
Rust rust(Vec3f p, const RustParams& r, float width) noexcept {
    const float frequency = within(r.frequency, 1e-6f, 1e6f);
    const Vec3f q = coordinate(p) * frequency;
    const float w = footprint(width) * frequency;
    const float spread = within(r.spread, 0.0f, 1.0f);

    const FractalParams patches{.octaves = 7, .diminish = within(r.detail, 0.0f, 0.9f)};
    const float variance = fractal3d_lost(patches, kInfinity);
    const float edge = variance * sqr(0.002f + 0.6f * within(r.softness, 0.0f, 1.0f));
    const float n = fractal3d(q, patches, w), lost = fractal3d_lost(patches, w);
    const float depth = n + std::sqrt(variance + edge) * normal_quantile(spread);
    const float z = depth / std::sqrt(edge + lost);

    Rust out;
    if (spread > 0.0f) out.mask = spread < 1.0f ? normal_cdf(z) : 1.0f;

    // Colour is of the rusted part alone, which is deeper than the footprint's mean.
    const float inside =
        (depth + lost / std::sqrt(edge + lost) * mean_above(z)) / std::sqrt(variance);
    const FractalParams fine{.octaves = 6, .diminish = 0.75f};
    const float s = 5.0f, speckle = fractal3d(q * s + Vec3f(31.7f), fine, w * s);
    const float blur = 1.0f + sqr(2.2f) * fractal3d_lost(fine, w * s);
    const float crust = normal_cdf((2.2f * speckle - 1.1f * inside) / std::sqrt(blur));
    out.color = lerp(r.dark, r.bright, crust);
    out.height = out.mask * clamp01(0.55f + 0.35f * speckle);
    out.roughness = 0.88f + 0.1f * std::clamp(speckle, -1.0f, 1.0f);
    return out;
}

}  // namespace tessera
