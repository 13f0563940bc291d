#include "renderer/core/sampler.h"

#include <bit>

namespace tessera {
namespace {

constexpr int kFew = 3;  // lanes that are drawn for one by one

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}

// Permutes bits upward only: each bit is flipped depending on the lower ones. On reversed numbers
// that is Owen's nested scrambling. Vegdahl 2021.
inline std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Sobol's second dimension, bit-reversed: its direction numbers are the rows of Pascal's triangle
// mod 2, so that the product is the polynomial P(x + 1), by halves: (x + 1)^(2^k) = x^(2^k) + 1.
inline std::uint32_t sobol_1_reversed(std::uint32_t p) {
    p ^= (p >> 16) & 0x0000ffffu;
    p ^= (p >> 8) & 0x00ff00ffu;
    p ^= (p >> 4) & 0x0f0f0f0fu;
    p ^= (p >> 2) & 0x33333333u;
    p ^= (p >> 1) & 0x55555555u;
    return p;
}

inline float to_unit(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
}

struct Scramble {
    std::uint32_t seed, shuffled;  // of the pair, and the index shuffled by it, bit-reversed
    Scramble(std::uint32_t pixel_seed, std::uint32_t reversed_index, std::uint32_t pair)
        : seed(hash_combine(pixel_seed, pair)),
          shuffled(reverse_bits(laine_karras(reversed_index, seed))) {}
    float x() const {
        return to_unit(reverse_bits(laine_karras(shuffled, hash_u32(seed + 0x9e3779b9u))));
    }
    float y() const {
        return to_unit(
            reverse_bits(laine_karras(sobol_1_reversed(shuffled), hash_u32(seed + 0x3c6ef372u))));
    }
};

}  // namespace

void sample_pairs(const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                  std::uint32_t pair, SamplePairs& out) noexcept {
    const std::uint32_t reversed = reverse_bits(index);
    for (int lane = 0; lane < kLanes; ++lane) {
        const Scramble s(pixel_seeds[lane], reversed, pair);
        out.x[lane] = s.x();
        out.y[lane] = s.y();
    }
}

void sample_singles(const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                    std::uint32_t pair, float (&out)[kLanes]) noexcept {
    const std::uint32_t reversed = reverse_bits(index);
    for (int lane = 0; lane < kLanes; ++lane)
        out[lane] = Scramble(pixel_seeds[lane], reversed, pair).x();
}

Vec2f sample_pair(std::uint32_t pixel_seed, std::uint32_t index, std::uint32_t pair) noexcept {
    const Scramble s(pixel_seed, reverse_bits(index), pair);
    return {s.x(), s.y()};
}

float sample_single(std::uint32_t pixel_seed, std::uint32_t index, std::uint32_t pair) noexcept {
    return Scramble(pixel_seed, reverse_bits(index), pair).x();
}

void draw_lanes(LaneMask lanes, const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                std::uint32_t pair, SamplePairs& out) noexcept {
    if (std::popcount(lanes) > kFew) return sample_pairs(pixel_seeds, index, pair, out);
    for (; lanes != 0; lanes &= lanes - 1) {
        const int i = std::countr_zero(lanes);
        const Vec2f p = sample_pair(pixel_seeds[i], index, pair);
        out.x[i] = p.x;
        out.y[i] = p.y;
    }
}

void draw_lanes(LaneMask lanes, const std::uint32_t (&pixel_seeds)[kLanes], std::uint32_t index,
                std::uint32_t pair, float (&out)[kLanes]) noexcept {
    if (std::popcount(lanes) > kFew) return sample_singles(pixel_seeds, index, pair, out);
    for (; lanes != 0; lanes &= lanes - 1) {
        const int i = std::countr_zero(lanes);
        out[i] = sample_single(pixel_seeds[i], index, pair);
    }
}

}  // namespace tessera
