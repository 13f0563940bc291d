#include "materials/nodes/lattice.h"
#include "materials/nodes/noise.h"

namespace tessera {
namespace {

// What box-filtered cells keep of their deviation from the mean, per axis, as the box grows beyond
// one cell: about the regression of the wider mean on the narrower, 3 / (2w + 1), brought to zero.
float kept_beyond_cell(float w) {
    const float k = 3.0f / (2.0f * std::max(w, 1.0f) + 1.0f), end = 3.0f / 17.0f;
    return std::max(k - end, 0.0f) * (1.0f / (1.0f - end));
}

// A box of at most one cell, on one axis: the cell where it begins and its share in the next.
struct Overlap {
    std::int32_t i;
    float next;
};
Overlap overlap(float x, float width) {
    const float w = std::min(width, 1.0f);
    const LatticeCell c = lattice_cell(x);
    if (w == 0.0f) return {c.i, 0.0f};
    const float above = (c.f + 0.5f * w - 1.0f) / w;
    if (above > 0.0f) return {c.i, above};
    const float below = (0.5f * w - c.f) / w;
    return below > 0.0f ? Overlap{c.i - 1, 1.0f - below} : Overlap{c.i, 0.0f};
}

// Sum of of(hash) over the cells under the box, each with its share.
template <class Value, class Of>
Value box_cells(Vec2f p, float w, std::uint32_t seed, Of of) {
    const Overlap x = overlap(p.x, w), y = overlap(p.y, w);
    Value sum{};
    for (int i = 0; i < 4; ++i) {
        const float share = ((i & 1) ? x.next : 1.0f - x.next) * ((i & 2) ? y.next : 1.0f - y.next);
        if (share > 0.0f) sum += of(cell_hash(x.i + (i & 1), y.i + (i >> 1), seed)) * share;
    }
    return sum;
}
template <class Value, class Of>
Value box_cells(Vec3f p, float w, std::uint32_t seed, Of of) {
    const Overlap z = overlap(p.z, w);
    const auto layer = [&](int i) {
        const std::uint32_t s = hash_combine(seed, static_cast<std::uint32_t>(z.i + i));
        return box_cells<Value>(Vec2f{p.x, p.y}, w, s, of);
    };
    Value sum = layer(0) * (1.0f - z.next);
    if (z.next > 0.0f) sum += layer(1) * z.next;
    return sum;
}

float fade(Vec2f, float w) { return sqr(kept_beyond_cell(w)); }
float fade(Vec3f, float w) { return sqr(kept_beyond_cell(w)) * kept_beyond_cell(w); }

constexpr std::uint32_t kCellSeed = 0x43454c4cu;

template <class Value, class Vec, class Of>
Value cell_noise(Vec p, float width, Of of) {
    if (is_nan(p)) return Value{};
    const float w = footprint(width), share = fade(p, w);
    const Value mean = Value(0.5f);
    return share > 0.0f ? mean + (box_cells<Value>(p, w, kCellSeed, of) - mean) * share : mean;
}

}  // namespace

float cellnoise2d(Vec2f p, float width) noexcept { return cell_noise<float>(p, width, unit_float); }
float cellnoise3d(Vec3f p, float width) noexcept { return cell_noise<float>(p, width, unit_float); }
Vec3f cellnoise2d_vec3(Vec2f p, float width) noexcept {
    return cell_noise<Vec3f>(p, width, unit_vec3);
}
Vec3f cellnoise3d_vec3(Vec3f p, float width) noexcept {
    return cell_noise<Vec3f>(p, width, unit_vec3);
}

}  // namespace tessera
