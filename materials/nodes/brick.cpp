#include "materials/nodes/box_filter.h"
#include "materials/nodes/noise.h"
#include "materials/nodes/pattern.h"

namespace tessera {
namespace {

constexpr std::uint32_t kBrickSeed = 0x4252434bu;
// Footprints of up to this many bricks a side are summed brick by brick.
constexpr float kSummed = 3.0f, kGone = 4.0f;

// A brick on one axis of its cell [0, 1]: bare up to `edge` at both ends, rounded over `bevel`.
struct Profile {
    float edge, bevel;

    float height(float t) const {
        const float u = clamp01((std::min(t, 1.0f - t) - edge) / bevel);
        return u * (2.0f - u);
    }
    float integral(float t) const {
        const float half = half_integral(0.5f);
        return t < 0.5f ? half_integral(t) : 2.0f * half - half_integral(1.0f - t);
    }

private:
    float half_integral(float t) const {
        const float u = clamp01((t - edge) / bevel);
        return bevel * u * u * (1.0f - u * (1.0f / 3.0f)) + std::max(t - edge - bevel, 0.0f);
    }
};

Profile profile(float pitch, float mortar, float rounding) {
    const float edge = 0.5f * mortar / pitch;
    return {edge, std::clamp(rounding / pitch, 1e-4f, std::max(0.5f - edge, 1e-4f))};
}

// Position and footprint in bricks, mortar included.
struct Grid {
    float x, y, wx, wy;
    float offset;  // of odd rows
    Profile across, up;
};

struct Relief {
    float brick, height;
};

// The bond repeats after two rows, each of which is a product of a function of x and one of y.
Relief relief(const Grid& g) {
    Relief sum{0.0f, 0.0f};
    for (int odd = 0; odd < 2; ++odd) {
        const float shift = static_cast<float>(odd), x = g.x - shift * g.offset;
        const auto row = [&](float t) { return 2.0f * t - shift; };
        const auto inside = [](float t) { return t >= 0.0f && t < 1.0f; };
        const float lo = 0.5f * (shift + g.up.edge), hi = 0.5f * (shift + 1.0f - g.up.edge);
        sum.brick += pulse_mean(x, g.wx, g.across.edge, 1.0f - g.across.edge) *
                     pulse_mean(0.5f * g.y, 0.5f * g.wy, lo, hi);
        const float across = periodic_mean(
            x, g.wx, [&](float t) { return g.across.height(t); },
            [&](float t) { return g.across.integral(t); });
        const float up = periodic_mean(
            0.5f * g.y, 0.5f * g.wy,
            [&](float t) { return inside(row(t)) ? g.up.height(row(t)) : 0.0f; },
            [&](float t) { return 0.5f * g.up.integral(row(t)); });
        sum.height += across * up;
    }
    return sum;
}

float row_shift(std::int32_t row, float offset) { return (row & 1) ? offset : 0.0f; }

std::uint32_t brick_at(const Grid& g, float x, float y) {
    const std::int32_t row = lattice_cell(y).i;
    return cell_hash(lattice_cell(x - row_shift(row, g.offset)).i, row, kBrickSeed);
}

Color brick_color(const BrickParams& b, float variation, std::uint32_t id) {
    const float tint = 0.5f + variation * (unit_float(id) - 0.5f);
    const float shade = 1.0f + 0.4f * variation * (unit_float(hash_u32(id)) - 0.5f);
    return lerp(b.color1, b.color2, tint) * shade;
}

// Length of [lo, hi] on brick i, without its mortar.
float covered(float lo, float hi, std::int32_t i, float edge) {
    const float f = static_cast<float>(i);
    return std::max(std::min(hi, f + 1.0f - edge) - std::max(lo, f + edge), 0.0f);
}

// Mean colour of the bricks under the footprint, each by its area.
Color summed_color(const Grid& g, const BrickParams& b, float variation) {
    Color sum;
    float area = 0.0f;
    const float y0 = g.y - 0.5f * g.wy, y1 = g.y + 0.5f * g.wy;
    for (std::int32_t j = lattice_cell(y0).i; j <= lattice_cell(y1).i; ++j) {
        const float up = covered(y0, y1, j, g.up.edge), shift = row_shift(j, g.offset);
        const float x0 = g.x - shift - 0.5f * g.wx, x1 = g.x - shift + 0.5f * g.wx;
        for (std::int32_t i = lattice_cell(x0).i; i <= lattice_cell(x1).i; ++i) {
            const float a = up * covered(x0, x1, i, g.across.edge);
            if (a > 0.0f) sum += brick_color(b, variation, cell_hash(i, j, kBrickSeed)) * a;
            area += a;
        }
    }
    return area > 0.0f ? sum / area : brick_color(b, variation, brick_at(g, g.x, g.y));
}

Color color_of_bricks(const Grid& g, const BrickParams& b) {
    const float variation = within(b.variation, 0.0f, 1.0f);
    const Color mean = lerp(b.color1, b.color2, 0.5f);
    const float w = std::max(g.wx, g.wy);
    if (w >= kGone) return mean;
    const float kept = 1.0f - clamp01((w - kSummed) / (kGone - kSummed));
    return lerp(mean, summed_color(g, b, variation), kept);
}

}  // namespace

Brick brick(Vec2f p, const BrickParams& b, float width) noexcept {
    const float mortar = within(b.mortar_width, 0.0f, 1e6f);
    const float rounding = within(b.rounding, 0.0f, 1e6f), w = footprint(width);
    const Vec2f pitch{within(b.size.x, 1e-6f, 1e6f) + mortar,
                      within(b.size.y, 1e-6f, 1e6f) + mortar};
    const Vec2f at = coordinate(p);

    // Wavy edges: the plane itself is bent a little, over lengths of about a brick's height.
    const float scale = 1.3f / pitch.y;
    const Vec3f bend =
        noise2d_vec3(at * scale, w * scale) * (mortar * within(b.irregularity, 0.0f, 1.0f));
    Grid g{coordinate((at.x + bend.x) / pitch.x),
           coordinate((at.y + bend.y) / pitch.y),
           w / pitch.x,
           w / pitch.y,
           within(b.row_offset, -1e3f, 1e3f),
           profile(pitch.x, mortar, rounding),
           profile(pitch.y, mortar, rounding)};

    const Relief r = relief(g);
    const float fine = 9.0f / pitch.y, broad = 0.25f / pitch.y;
    const float rough = within(b.grain, 0.0f, 1.0f);
    const float grain = rough * fractal2d(at * fine, {.octaves = 4, .diminish = 0.7f}, w * fine);
    // Weather and soot, over several bricks.
    const float stain =
        rough * fractal2d(at * broad + Vec2f{3.1f, 8.7f}, {.octaves = 5}, w * broad);
    Brick out;
    out.mortar = clamp01(1.0f - r.brick);
    out.color = lerp(color_of_bricks(g, b), b.mortar, out.mortar) *
                (std::max(1.0f + 0.6f * grain, 0.0f) * std::max(1.0f + 0.6f * stain, 0.0f));
    out.height = clamp01(0.05f + 0.87f * r.height + 0.08f * grain);
    out.id = brick_at(g, g.x, g.y);
    return out;
}

}  // namespace tessera
