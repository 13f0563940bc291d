#include "materials/nodes/lattice.h"
#include "materials/nodes/noise.h"

namespace tessera {
namespace {

constexpr std::uint32_t kPointSeed = 0x574f524cu;

// The two nearest points so far; positions relative to p.
struct Nearest {
    float d1 = kInfinity, d2 = kInfinity;  // squared distances
    Vec3f at1, at2;
    std::uint32_t id1 = 0, id2 = 0;

    void add(Vec3f at, std::uint32_t id) {
        const float d = length2(at);
        if (d < d1) {
            d2 = d1, at2 = at1, id2 = id1;
            d1 = d, at1 = at, id1 = id;
        } else if (d < d2) {
            d2 = d, at2 = at, id2 = id;
        }
    }
};

struct Place {
    LatticeCell x, y, z;
    float jitter;
};

// Bits of a hash as an offset from the cell's centre in [-0.5, 0.5), times the jitter.
float offset(std::uint32_t bits, int count, float jitter) {
    const float scale = 1.0f / static_cast<float>(1 << count);
    return 0.5f + jitter * (static_cast<float>(static_cast<std::int32_t>(bits)) * scale - 0.5f);
}

void add_cell_2d(const Place& p, int i, int j, Nearest& n) {
    const std::uint32_t h = cell_hash(p.x.i + i, p.y.i + j, kPointSeed);
    n.add({static_cast<float>(i) - p.x.f + offset(h & 0xffffu, 16, p.jitter),
           static_cast<float>(j) - p.y.f + offset(h >> 16, 16, p.jitter), 0.0f},
          h);
}

void add_cell_3d(const Place& p, int i, int j, int k, Nearest& n) {
    const std::uint32_t h = cell_hash(p.x.i + i, p.y.i + j, p.z.i + k, kPointSeed);
    n.add({static_cast<float>(i) - p.x.f + offset(h & 0x7ffu, 11, p.jitter),
           static_cast<float>(j) - p.y.f + offset((h >> 11) & 0x3ffu, 10, p.jitter),
           static_cast<float>(k) - p.z.f + offset(h >> 21, 11, p.jitter)},
          h);
}

// No point of the cells two away is nearer than this; those three away are never needed: the second
// nearest point is within sqrt(3), since the own cell and the one across the nearest wall hold one.
float second_ring(LatticeCell c) { return 1.0f + std::min(c.f, 1.0f - c.f); }

Nearest nearest_2d(const Place& p) {
    Nearest n;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) add_cell_2d(p, i, j, n);
    if (n.d2 > sqr(std::min(second_ring(p.x), second_ring(p.y))))
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i)
                if (std::max(std::abs(i), std::abs(j)) == 2) add_cell_2d(p, i, j, n);
    return n;
}

Nearest nearest_3d(const Place& p) {
    Nearest n;
    for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) add_cell_3d(p, i, j, k, n);
    const float ring = std::min({second_ring(p.x), second_ring(p.y), second_ring(p.z)});
    if (n.d2 > sqr(ring))
        for (int k = -2; k <= 2; ++k)
            for (int j = -2; j <= 2; ++j)
                for (int i = -2; i <= 2; ++i)
                    if (std::max({std::abs(i), std::abs(j), std::abs(k)}) == 2)
                        add_cell_3d(p, i, j, k, n);
    return n;
}

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
    Means mean1, mean2;
    float f1, f2, value;
};

float faded(float distance, float mean, float kept) { return mean + (distance - mean) * kept; }

Worley filtered(const Nearest& n, float jitter, float w, const Fades& fades) {
    Worley out{std::sqrt(n.d1), std::sqrt(n.d2), unit_float(hash_u32(n.id1)), n.id1};
    if (w == 0.0f) return out;
    out.f1 = faded(out.f1, fades.mean1.at(jitter), fade_out(w, fades.f1));
    out.f2 = faded(out.f2, fades.mean2.at(jitter), fade_out(w, fades.f2));
    // Across the border, half way between the two points, the other's value comes in.
    const float apart = length(n.at2 - n.at1);
    const float inside = apart > 0.0f ? 0.5f * (n.d2 - n.d1) / apart : 0.0f;
    const float own = std::min(0.5f + inside / w, 1.0f);
    const float other = unit_float(hash_u32(n.id2));
    out.value = faded(out.value * own + other * (1.0f - own), 0.5f, fade_out(w, fades.value));
    return out;
}

constexpr Fades kFades2d{
    {0.3827f, 0.0538f, -0.0071f}, {0.6994f, 0.0126f, -0.0132f}, 2.2f, 2.6f, 4.9f};
constexpr Fades kFades3d{
    {0.4807f, 0.0469f, -0.0067f}, {0.7027f, 0.0431f, -0.0285f}, 2.5f, 2.7f, 4.6f};

}  // namespace

Worley worleynoise2d(Vec2f p, float jitter, float width) noexcept {
    if (is_nan(p)) return {};
    const float j = within(jitter, 0.0f, 1.0f);
    return filtered(nearest_2d({lattice_cell(p.x), lattice_cell(p.y), {}, j}), j, footprint(width),
                    kFades2d);
}

Worley worleynoise3d(Vec3f p, float jitter, float width) noexcept {
    if (is_nan(p)) return {};
    const float j = within(jitter, 0.0f, 1.0f);
    return filtered(nearest_3d({lattice_cell(p.x), lattice_cell(p.y), lattice_cell(p.z), j}), j,
                    footprint(width), kFades3d);
}

}  // namespace tessera
