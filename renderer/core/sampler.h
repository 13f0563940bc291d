#pragma once
// Owen-scrambled Sobol points as a pure function of (pixel, sample index, dimension pair, seed).
//
// Every pair of dimensions is Sobol's first two (a (0,2)-sequence), its index shuffled and its
// values scrambled by hashed nested permutations: Burley, "Practical Hash-based Owen Scrambling",
// JCGT 9(4), 2020, with the hash of Vegdahl, "Building a Better LK Hash", 2021. Sixteen lanes at a
// time, so that the compiler vectorises.

#include <bit>
#include <cstdint>

#include "renderer/core/ray.h"
#include "renderer/core/vec.h"

namespace tessera {

/// Dimension pairs: the camera's, then kPairsPerVertex for each path vertex. A new use takes a new
/// pair.
namespace dim {
inline constexpr std::uint32_t kFilter = 0;
inline constexpr std::uint32_t kLens = 1;
inline constexpr std::uint32_t kOpacity = 2;  // hashed per primitive, not a pair
inline constexpr std::uint32_t kFirstVertex = 8;
inline constexpr std::uint32_t kPairsPerVertex = 8;
inline constexpr std::uint32_t kLight = 0;   // point on the light
inline constexpr std::uint32_t kChoice = 1;  // x: which light, y: which lobe
inline constexpr std::uint32_t kBsdf = 2;    // direction
inline constexpr std::uint32_t kRoulette = 3;
inline constexpr std::uint32_t kOcclusion = 4;  // a pass
constexpr std::uint32_t vertex(std::uint32_t depth, std::uint32_t use) {
    return kFirstVertex + depth * kPairsPerVertex + use;
}
}  // namespace dim

/// Integer hash with good avalanche (Wellons, "Prospecting for Hash Functions", lowbias32).
constexpr std::uint32_t hash_u32(std::uint32_t x) {
    x ^= x >> 16, x *= 0x7feb352du;
    x ^= x >> 15, x *= 0x846ca68bu;
    return x ^ (x >> 16);
}
constexpr std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b) {
    return hash_u32(a ^ (b * 0x9e3779b9u + 0x7f4a7c15u));
}

/// Seed of a pixel's scrambles. Pixels are absolute in the frame.
constexpr std::uint32_t pixel_seed(int x, int y, std::uint64_t seed) {
    const std::uint32_t s =
        hash_combine(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32));
    return hash_combine(hash_combine(static_cast<std::uint32_t>(x), s),
                        static_cast<std::uint32_t>(y) ^ 0x68bc21ebu);
}

/// Where in a pixel's sequences its n-th sample lies. Between two powers of two both halves of what
/// is to come take turns, so that at any time the points make four runs of a sequence
/// (renderer/error/replicates.h).
constexpr std::uint32_t point_of_sample(std::uint32_t n) {
    if (n < 2) return n;
    const std::uint32_t half = std::bit_floor(n) / 2, past = n - 2 * half;
    return 2 * half + (past % 2) * half + past / 2;
}

struct SamplePairs {
    float x[kLanes];
    float y[kLanes];
    Vec2f at(int lane) const { return {x[lane], y[lane]}; }
};

/// The points of one dimension pair for sixteen pixels at one sample index; each in [0, 1).
void sample_pairs(const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                  std::uint32_t pair, SamplePairs& out) noexcept;

/// One lane of the above.
Vec2f sample_pair(std::uint32_t pixel_seed, std::uint32_t index, std::uint32_t pair) noexcept;

/// The first of a pair alone.
void sample_singles(const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                    std::uint32_t pair, float (&out)[kLanes]) noexcept;
float sample_single(std::uint32_t pixel_seed, std::uint32_t index, std::uint32_t pair) noexcept;

/// The same points for some lanes: all at once, which is vectorised, or the few one by one.
void draw_lanes(LaneMask lanes, const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                std::uint32_t pair, SamplePairs& out) noexcept;
void draw_lanes(LaneMask lanes, const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                std::uint32_t pair, float (&out)[kLanes]) noexcept;

}  // namespace tessera
