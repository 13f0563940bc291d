#pragma once
// Noise with the meaning that MaterialX gives it, filtered by a footprint.
//
// `width` is the side of the footprint in the units of p: 0 takes the point alone; as the footprint
// outgrows what the noise shows, the value fades to its mean. Any p is allowed: beyond +-2^30 a
// coordinate is taken as +-2^30; NaN in p gives 0. Amplitude and pivot are the caller's.

#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

/// Gradient noise, mean 0, in about [-1, 1], zero at integers. Perlin, "Improving Noise", 2002.
float noise2d(Vec2f p, float width) noexcept;
float noise3d(Vec3f p, float width) noexcept;
/// Three independent channels.
Vec3f noise2d_vec3(Vec2f p, float width) noexcept;
Vec3f noise3d_vec3(Vec3f p, float width) noexcept;

struct FractalParams {
    int octaves = 3;          // 0 to 24
    float lacunarity = 2.0f;  // frequency of an octave over the one before
    float diminish = 0.5f;    // amplitude likewise, within +-4
};

/// Sum over octaves of diminish^i noise(lacunarity^i p). One octave is the noise itself.
float fractal2d(Vec2f p, const FractalParams& f, float width) noexcept;
float fractal3d(Vec3f p, const FractalParams& f, float width) noexcept;
Vec3f fractal2d_vec3(Vec2f p, const FractalParams& f, float width) noexcept;
Vec3f fractal3d_vec3(Vec3f p, const FractalParams& f, float width) noexcept;

/// The variance of a channel that filtering takes away, for what is not linear in the sum: the
/// points of the footprint are spread about the filtered value by that much. All of it at infinity.
float fractal3d_lost(const FractalParams& f, float width) noexcept;

/// A number in [0, 1) for each unit cell.
float cellnoise2d(Vec2f p, float width) noexcept;
float cellnoise3d(Vec3f p, float width) noexcept;
Vec3f cellnoise2d_vec3(Vec2f p, float width) noexcept;
Vec3f cellnoise3d_vec3(Vec3f p, float width) noexcept;

/// Distances to the nearest and second nearest of the points strewn one into each cell. Worley, "A
/// Cellular Texture Basis Function", SIGGRAPH 1996.
struct Worley {
    float f1 = 0.0f, f2 = 0.0f;
    float value = 0.0f;    // in [0, 1) for the nearest point, its borders filtered
    std::uint32_t id = 0;  // of the nearest point; not filtered
};
/// jitter is clamped to [0, 1]; with 0 the points are the cells' centres.
Worley worleynoise2d(Vec2f p, float jitter, float width) noexcept;
Worley worleynoise3d(Vec3f p, float jitter, float width) noexcept;
/// Distances to the nearest three points.
Vec3f worleynoise2d_vec3(Vec2f p, float jitter, float width) noexcept;
Vec3f worleynoise3d_vec3(Vec3f p, float jitter, float width) noexcept;

}  // namespace tessera
