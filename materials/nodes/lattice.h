#pragma once
// The integer lattice under all procedural textures: where a coordinate lies in it, and hashes of
// its cells.
//
// A coordinate beyond +-2^30 is taken as +-2^30; far before that, from 2^23 on, a float has no
// fraction left and every texture is constant or zero.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/core/sampler.h"
#include "renderer/core/vec.h"

namespace tessera {

struct LatticeCell {
    std::int32_t i;
    float f;  // position in the cell, in [0, 1)
};

/// x is not NaN.
inline LatticeCell lattice_cell(float x) {
    const float inside = std::clamp(x, -0x1p30f, 0x1p30f), floor = std::floor(inside);
    return {static_cast<std::int32_t>(floor), inside - floor};
}

inline bool is_nan(Vec2f p) { return std::isnan(p.x) || std::isnan(p.y); }
inline bool is_nan(Vec3f p) { return std::isnan(p.x) || std::isnan(p.y) || std::isnan(p.z); }

/// A footprint's diameter: not negative, not NaN, finite.
inline float footprint(float width) { return width > 0.0f ? std::min(width, 1e18f) : 0.0f; }

/// A pattern's coordinate: NaN counts as 0.
inline float coordinate(float x) { return std::isnan(x) ? 0.0f : std::clamp(x, -0x1p30f, 0x1p30f); }
inline Vec2f coordinate(Vec2f p) { return {coordinate(p.x), coordinate(p.y)}; }
inline Vec3f coordinate(Vec3f p) { return {coordinate(p.x), coordinate(p.y), coordinate(p.z)}; }

/// A parameter within [low, high]; NaN gives low.
inline float within(float x, float low, float high) { return x > low ? std::min(x, high) : low; }

/// How much of a texture's deviation from its mean is left under a footprint of side w; zero from
/// `gone` on. The fade of a band-limited texture to its mean is the frequency clamping of Ebert et
/// al., "Texturing & Modeling", 3rd ed., 2003, ch. 2.
inline float fade_out(float w, float gone) {
    return sqr(sqr(1.0f - sqr(std::min(w / gone, 1.0f))));
}

/// Chained hash_u32, whose bits are all well mixed.
inline std::uint32_t cell_hash(std::int32_t x, std::int32_t y, std::uint32_t seed) {
    return hash_combine(hash_combine(seed, static_cast<std::uint32_t>(y)),
                        static_cast<std::uint32_t>(x));
}
inline std::uint32_t cell_hash(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
    return cell_hash(x, y, hash_combine(seed, static_cast<std::uint32_t>(z)));
}

/// In [0, 1), on a grid of 2^-24.
inline float unit_float(std::uint32_t bits) {
    return static_cast<float>(static_cast<std::int32_t>(bits >> 8)) * 0x1p-24f;
}
/// Three such numbers from one hash.
inline Vec3f unit_vec3(std::uint32_t h) {
    return {unit_float(h), unit_float(hash_u32(h + 0x9e3779b9u)),
            unit_float(hash_u32(h + 0x3c6ef372u))};
}

}  // namespace tessera
