#include "materials/nodes/noise.h"

#include <bit>

#include "materials/nodes/lattice.h"

namespace tessera {
namespace {

// Range about [-1, 1], as MaterialX scales it.
constexpr float kScale2d = 0.6616f, kScale3d = 0.982f;
// Measured over 1e7 points.
constexpr float kVariance3d = 0.0703f;

float quintic(float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); }
float mix(float a, float b, float t) { return a + (b - a) * t; }

// x, or -x when the lowest bit of h is set.
float flip(float x, std::uint32_t h) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) ^ (h << 31));
}

// Dot product with one of (+-1, +-2), (+-2, +-1): three bits of h.
float along(std::uint32_t h, float x, float y) {
    const float a = (h & 4u) ? x : y, b = (h & 4u) ? y : x;
    return flip(a, h) + 2.0f * flip(b, h >> 1);
}

// Dot product with one of the twelve (+-1, +-1, 0), (+-1, 0, +-1), (0, +-1, +-1) of Perlin 2002:
// ten bits of h.
float along(std::uint32_t h, float x, float y, float z) {
    const std::uint32_t zero = ((h & 0xffu) * 3u) >> 8;  // the axis without a part
    const float a = zero == 0 ? y : x, b = zero == 2 ? y : z;
    return flip(a, h >> 8) + flip(b, h >> 9);
}

struct Values {
    float of[3];
};

// The first n channels; each takes ten bits of a corner's hash.
template <int n>
Values gradient_noise(Vec2f p, std::uint32_t seed) {
    const LatticeCell x = lattice_cell(p.x), y = lattice_cell(p.y);
    std::uint32_t h[4];
    for (int i = 0; i < 4; ++i) h[i] = cell_hash(x.i + (i & 1), y.i + (i >> 1), seed);
    const float tx = quintic(x.f), ty = quintic(y.f);
    Values out{};
    for (int c = 0; c < n; ++c) {
        float d[4];
        for (int i = 0; i < 4; ++i)
            d[i] = along(h[i] >> (10 * c), x.f - static_cast<float>(i & 1),
                         y.f - static_cast<float>(i >> 1));
        out.of[c] = kScale2d * mix(mix(d[0], d[1], tx), mix(d[2], d[3], tx), ty);
    }
    return out;
}

template <int n>
Values gradient_noise(Vec3f p, std::uint32_t seed) {
    const LatticeCell x = lattice_cell(p.x), y = lattice_cell(p.y), z = lattice_cell(p.z);
    std::uint32_t hz[2], h[8];
    for (int i = 0; i < 2; ++i) hz[i] = hash_combine(seed, static_cast<std::uint32_t>(z.i + i));
    for (int i = 0; i < 8; ++i) h[i] = cell_hash(x.i + (i & 1), y.i + ((i >> 1) & 1), hz[i >> 2]);
    const float tx = quintic(x.f), ty = quintic(y.f), tz = quintic(z.f);
    Values out{};
    for (int c = 0; c < n; ++c) {
        float d[8];
        for (int i = 0; i < 8; ++i)
            d[i] = along(h[i] >> (10 * c), x.f - static_cast<float>(i & 1),
                         y.f - static_cast<float>((i >> 1) & 1), z.f - static_cast<float>(i >> 2));
        out.of[c] = kScale3d * mix(mix(mix(d[0], d[1], tx), mix(d[2], d[3], tx), ty),
                                   mix(mix(d[4], d[5], tx), mix(d[6], d[7], tx), ty), tz);
    }
    return out;
}

// Fitted to the measured correlation of the point value with the mean over the footprint, so that
// the filtered noise has about the least squared error; within 0.1 of it.
float fade(Vec2f, float w) { return fade_out(w, 2.55f); }
float fade(Vec3f, float w) { return fade_out(w, 2.85f); }  // a square in a plane of any direction

Vec2f moved(Vec2f p, float scale, float shift) {
    return {p.x * scale + 0.37f * shift, p.y * scale + 0.71f * shift};
}
Vec3f moved(Vec3f p, float scale, float shift) {
    return {p.x * scale + 0.37f * shift, p.y * scale + 0.71f * shift, p.z * scale + 0.53f * shift};
}

struct Octave {
    float frequency = 1.0f, amplitude = 1.0f;
};

// Calls each(octave, number) for the octaves in turn.
template <class Each>
void for_octaves(const FractalParams& f, Each each) {
    const float lacunarity = within(f.lacunarity, -1e3f, 1e3f);
    const float diminish = within(f.diminish, -4.0f, 4.0f);
    const int octaves = std::clamp(f.octaves, 0, 24);
    Octave o;
    for (int i = 0; i < octaves; ++i) {
        each(o, i);
        o.frequency = std::clamp(o.frequency * lacunarity, -0x1p60f, 0x1p60f);
        o.amplitude *= diminish;
    }
}

// The octaves' lattices are hashed differently and moved apart, so that their zeros do not
// coincide.
template <int n, class Vec>
Values fractal(Vec p, const FractalParams& f, float width) {
    Values sum{};
    if (is_nan(p)) return sum;
    const Vec start = coordinate(p);
    const float w = footprint(width);
    for_octaves(f, [&](Octave o, int i) {
        const float amplitude = o.amplitude * fade(p, w * std::fabs(o.frequency));
        if (amplitude == 0.0f) return;
        const Vec at = moved(start, o.frequency, static_cast<float>(i));
        const Values v = gradient_noise<n>(at, static_cast<std::uint32_t>(i));
        for (int c = 0; c < n; ++c) sum.of[c] += amplitude * v.of[c];
    });
    return sum;
}

constexpr FractalParams kOneOctave{.octaves = 1};

Vec3f vec3(const Values& v) { return {v.of[0], v.of[1], v.of[2]}; }

}  // namespace

float noise2d(Vec2f p, float width) noexcept { return fractal<1>(p, kOneOctave, width).of[0]; }
float noise3d(Vec3f p, float width) noexcept { return fractal<1>(p, kOneOctave, width).of[0]; }
Vec3f noise2d_vec3(Vec2f p, float width) noexcept { return vec3(fractal<3>(p, kOneOctave, width)); }
Vec3f noise3d_vec3(Vec3f p, float width) noexcept { return vec3(fractal<3>(p, kOneOctave, width)); }

float fractal2d(Vec2f p, const FractalParams& f, float width) noexcept {
    return fractal<1>(p, f, width).of[0];
}
float fractal3d(Vec3f p, const FractalParams& f, float width) noexcept {
    return fractal<1>(p, f, width).of[0];
}
Vec3f fractal2d_vec3(Vec2f p, const FractalParams& f, float width) noexcept {
    return vec3(fractal<3>(p, f, width));
}
Vec3f fractal3d_vec3(Vec3f p, const FractalParams& f, float width) noexcept {
    return vec3(fractal<3>(p, f, width));
}

float fractal3d_lost(const FractalParams& f, float width) noexcept {
    const float w = footprint(width);
    float lost = 0.0f;
    for_octaves(f, [&](Octave o, int) {
        const float share = sqr(fade(Vec3f(), w * std::fabs(o.frequency)));
        lost += sqr(o.amplitude) * kVariance3d * (1.0f - share);
    });
    return lost;
}

}  // namespace tessera
