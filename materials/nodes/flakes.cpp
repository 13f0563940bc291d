#include "materials/nodes/flakes.h"

#include "materials/nodes/lattice.h"
#include "materials/nodes/nearest_points.h"
#include "renderer/core/fast_math.h"

namespace tessera {
namespace {

constexpr std::uint32_t kFlakeSeed = 0x464c414bu;
// Footprint, in flakes, that shows no single one any more.
constexpr float kGone = 4.0f;

struct Flake {
    bool there;
    float random;
    Vec3f slope;  // along the surface
};

Flake flake(std::uint32_t cell, Vec3f n, const FlakeParams& f, float alpha) {
    const std::uint32_t id = hash_combine(kFlakeSeed, cell);
    Flake out{unit_float(id) < f.coverage, unit_float(hash_u32(id + 1)), Vec3f(0.0f)};
    if (!out.there) return out;
    const Vec3f u = unit_vec3(hash_u32(id + 2));
    // A direction that is even on the sphere is even about any normal.
    const SinCos turn = sincos_turn(u.y);
    const float z = 2.0f * u.z - 1.0f, r = safe_sqrt(1.0f - z * z);
    const Vec3f d = Vec3f{r * turn.cos, r * turn.sin, z};
    const Vec3f along = d - n * dot(d, n);
    // Walter et al. 2007, eq. 35; the last of 10000 flakes is left at the tilt of the one before.
    const float part = std::min(u.x, 0.9999f), tilt = alpha * std::sqrt(part / (1.0f - part));
    out.slope = along * (tilt / std::sqrt(std::max(length2(along), 1e-12f)));
    return out;
}

// Slopes of GGX spread under addition between a normal distribution's, whose squares add, and
// Cauchy's, which add: about as alpha^(3/2), the cube of the roughness.
float spread_of(float share) { return share * std::sqrt(share); }

float cube(float x) { return x * x * x; }

}  // namespace

Flakes flakes(Vec3f p, Vec3f n, const FlakeParams& given, float width) noexcept {
    const float unit = 1.0f / within(given.size, 1e-6f, 1e6f), w = footprint(width) * unit;
    const FlakeParams f{given.size, within(given.coverage, 0.0f, 1.0f),
                        within(given.spread, 0.0f, 1.0f), within(given.roughness, 0.0f, 1.0f)};
    const float l2 = length2(n);
    const Vec3f up = l2 > 1e-30f && l2 < 1e30f ? n / std::sqrt(l2) : Vec3f{0.0f, 0.0f, 1.0f};

    const NearestPoints near = nearest_points(coordinate(coordinate(p) * unit), 1.0f);
    const float shown = fade_out(w, kGone), own = w > 0.0f ? near.own_share(w) : 1.0f;
    const float alpha = sqr(f.spread);
    const Flake a = flake(near.id1, up, f, alpha), b = flake(near.id2, up, f, alpha);

    // The footprint as three parts: the nearest cell, the one beside it, and many others.
    const float share_a = shown * own * (a.there ? 1.0f : 0.0f);
    const float share_b = shown * (1.0f - own) * (b.there ? 1.0f : 0.0f);
    const float others = (1.0f - shown) * f.coverage;

    Flakes out;
    out.mask = share_a + share_b + others;
    out.random = 0.5f + shown * (own * a.random + (1.0f - own) * b.random - 0.5f);
    // Of what is flake; where that is little it does not matter, but must not come at once.
    const float whole = std::max(out.mask, std::max(0.125f * f.coverage, 1e-6f));
    const float of_a = share_a / whole, of_b = share_b / whole, of_others = others / whole;
    const float lost = of_a + of_b - spread_of(of_a) - spread_of(of_b) + of_others;
    out.normal = normalize(up + a.slope * of_a + b.slope * of_b);
    out.roughness =
        std::cbrt(std::min(cube(f.roughness) + cube(f.spread) * std::max(lost, 0.0f), 1.0f));
    return out;
}

}  // namespace tessera
