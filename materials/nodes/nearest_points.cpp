#include "materials/nodes/nearest_points.h"

#include "materials/nodes/lattice.h"

namespace tessera {
namespace {

constexpr std::uint32_t kPointSeed = 0x574f524cu;

struct Place {
    LatticeCell x, y, z;
    float jitter;
};

// Bits of a hash as an offset from the cell's centre in [-0.5, 0.5), times the jitter.
float offset(std::uint32_t bits, int count, float jitter) {
    const float scale = 1.0f / static_cast<float>(1 << count);
    return 0.5f + jitter * (static_cast<float>(static_cast<std::int32_t>(bits)) * scale - 0.5f);
}

void add_cell_2d(const Place& p, int i, int j, NearestPoints& n) {
    const std::uint32_t h = cell_hash(p.x.i + i, p.y.i + j, kPointSeed);
    n.add({static_cast<float>(i) - p.x.f + offset(h & 0xffffu, 16, p.jitter),
           static_cast<float>(j) - p.y.f + offset(h >> 16, 16, p.jitter), 0.0f},
          h);
}

void add_cell_3d(const Place& p, int i, int j, int k, NearestPoints& n) {
    const std::uint32_t h = cell_hash(p.x.i + i, p.y.i + j, p.z.i + k, kPointSeed);
    n.add({static_cast<float>(i) - p.x.f + offset(h & 0x7ffu, 11, p.jitter),
           static_cast<float>(j) - p.y.f + offset((h >> 11) & 0x3ffu, 10, p.jitter),
           static_cast<float>(k) - p.z.f + offset(h >> 21, 11, p.jitter)},
          h);
}

// No point of the cells two away is nearer than this; those three away are never needed: the second
// nearest point is within sqrt(3), since the own cell and the one across the nearest wall hold one.
float second_ring(LatticeCell c) { return 1.0f + std::min(c.f, 1.0f - c.f); }

template <float NearestPoints::*farthest>
NearestPoints search(Vec2f at, float jitter) {
    const Place p{lattice_cell(at.x), lattice_cell(at.y), {}, jitter};
    NearestPoints n;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) add_cell_2d(p, i, j, n);
    if (n.*farthest > sqr(std::min(second_ring(p.x), second_ring(p.y))))
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i)
                if (std::max(std::abs(i), std::abs(j)) == 2) add_cell_2d(p, i, j, n);
    return n;
}

template <float NearestPoints::*farthest>
NearestPoints search(Vec3f at, float jitter) {
    const Place p{lattice_cell(at.x), lattice_cell(at.y), lattice_cell(at.z), jitter};
    NearestPoints n;
    for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) add_cell_3d(p, i, j, k, n);
    const float ring = std::min({second_ring(p.x), second_ring(p.y), second_ring(p.z)});
    if (n.*farthest > sqr(ring))
        for (int k = -2; k <= 2; ++k)
            for (int j = -2; j <= 2; ++j)
                for (int i = -2; i <= 2; ++i)
                    if (std::max({std::abs(i), std::abs(j), std::abs(k)}) == 2)
                        add_cell_3d(p, i, j, k, n);
    return n;
}

}  // namespace

NearestPoints nearest_points(Vec2f at, float jitter) noexcept {
    return search<&NearestPoints::d2>(at, jitter);
}
NearestPoints nearest_points(Vec3f at, float jitter) noexcept {
    return search<&NearestPoints::d2>(at, jitter);
}
NearestPoints nearest_three(Vec2f at, float jitter) noexcept {
    return search<&NearestPoints::d3>(at, jitter);
}
NearestPoints nearest_three(Vec3f at, float jitter) noexcept {
    return search<&NearestPoints::d3>(at, jitter);
}

}  // namespace tessera
