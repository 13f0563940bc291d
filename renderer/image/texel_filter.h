#pragma once
// Filters over any picture that gives single texels, in memory or in the tile cache. A Source has
//   int levels(), width(level), height(level)   level 0 the finest
//   Texel texel(level, x, y)                     row 0 at the top, inside the picture
//   bool has_alpha()
// The trilinear filter makes the bits that sample_pyramid() makes.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "renderer/core/sampler.h"
#include "renderer/image/texture.h"

namespace tessera {

/// The two texels a coordinate lies between, and their weights.
struct Taps {
    int first, second;
    float f;                   // share of the second
    float inside[2] = {1, 1};  // 0 where Wrap::black has no texel
};

/// The texel that stands for number i outside of [0, n), at most one period of the wrap away.
inline int wrap_index(int i, int n, Wrap wrap) noexcept {
    switch (wrap) {
        case Wrap::repeat:
            return i < 0 ? i + n : i - n;
        case Wrap::mirror:
            if (i < 0) i = -1 - i;
            return i < n ? i : std::max(0, 2 * n - 1 - i);
        case Wrap::clamp:
        case Wrap::black:
            return i < 0 ? 0 : n - 1;
    }
    return 0;
}

/// The same for any i: a cubic's taps reach far beyond tiny levels. inside becomes 0 where
/// Wrap::black has no texel.
inline int wrap_far(int i, int n, Wrap wrap, float& inside) noexcept {
    if (i >= 0 && i < n) return i;
    if (wrap == Wrap::black) inside = 0;
    const int period = wrap == Wrap::mirror ? 2 * n : n;
    if (wrap == Wrap::repeat || wrap == Wrap::mirror) {
        i %= period;
        if (i < 0) i += period;
    }
    return i >= 0 && i < n ? i : wrap_index(i, n, wrap);
}

/// u folded, in texture units; texel centres at (i + 0.5) / n. The wrap is applied to each texel,
/// so that a repeating picture is interpolated across its seam.
[[gnu::always_inline]] inline Taps find_taps(float u, int n, Wrap wrap) noexcept {
    const float x = u * static_cast<float>(n) - 0.5f;
    const float floor_x = std::floor(x);
    const int i = static_cast<int>(floor_x);
    Taps taps{i, i + 1, x - floor_x};
    if (i >= 0 && i + 1 < n) [[likely]]
        return taps;
    for (int k = 0; k < 2; ++k) {
        int& tap = k == 0 ? taps.first : taps.second;
        if (tap >= 0 && tap < n) continue;
        if (wrap == Wrap::black) taps.inside[k] = 0;
        tap = wrap_index(tap, n, wrap);
    }
    return taps;
}

/// The coarser level's share lies between two levels.
struct LevelPair {
    int base = 0;
    float f = 0;  // share of base + 1
};

inline LevelPair split_level(float level, int levels) noexcept {
    const float clamped = level > 0 ? std::min(level, static_cast<float>(levels - 1)) : 0.0f;
    const int base = static_cast<int>(clamped);
    return {base, clamped - static_cast<float>(base)};
}

/// Weights of four texels by the uniform cubic B-spline, at f of the way from the second to the
/// third: positive, of sum 1, true to straight lines. Sigg and Hadwiger 2005.
inline void bspline_weights(float f, float (&w)[4]) noexcept {
    const float g = 1 - f, f2 = f * f, g2 = g * g;
    w[0] = g2 * g * (1.0f / 6);
    w[1] = (4 - 3 * f2 * (2 - f)) * (1.0f / 6);
    w[2] = (4 - 3 * g2 * (2 - g)) * (1.0f / 6);
    w[3] = f2 * f * (1.0f / 6);
}

template <class Source>
class TexelFilter {
public:
    TexelFilter(Source& source, Wrap wrap_u, Wrap wrap_v) noexcept
        : source_(source), wrap_u_(wrap_u), wrap_v_(wrap_v) {}

    /// u and v folded, v upward.
    Texel operator()(TextureFilter filter, float u, float v, float level,
                     std::uint32_t seed) noexcept {
        Texel sum{0, 0, 0, 0};
        const LevelPair l = split_level(level, source_.levels());
        switch (filter) {
            case TextureFilter::closest:
                nearest(u, v, sum);
                break;
            case TextureFilter::bilinear:
                add_bilinear(0, u, v, 1, sum);
                break;
            case TextureFilter::bicubic:
                add_bicubic(l.base, u, v, 1 - l.f, sum);
                if (l.f > 0) add_bicubic(l.base + 1, u, v, l.f, sum);
                break;
            case TextureFilter::stochastic:
                one_texel(l, u, v, seed, sum);
                break;
            case TextureFilter::trilinear:
                add_bilinear(l.base, u, v, 1 - l.f, sum);
                if (l.f > 0) add_bilinear(l.base + 1, u, v, l.f, sum);
                break;
        }
        if (!source_.has_alpha()) sum[3] = 1;
        return sum;
    }

private:
    void nearest(float u, float v, Texel& sum) noexcept {
        const int w = source_.width(0), h = source_.height(0);
        float inside = 1;
        const auto cell = [](float t, int n) {
            return static_cast<int>(std::floor(t * static_cast<float>(n)));
        };
        const int x = wrap_far(cell(u, w), w, wrap_u_, inside);
        const int y = wrap_far(cell(1 - v, h), h, wrap_v_, inside);
        if (inside > 0) sum = source_.texel(0, x, y);
    }

    void add_bilinear(int level, float u, float v, float scale, Texel& sum) noexcept {
        const Taps x = find_taps(u, source_.width(level), wrap_u_);
        const Taps y = find_taps(1 - v, source_.height(level), wrap_v_);
        const float x0 = (1 - x.f) * x.inside[0], x1 = x.f * x.inside[1];
        const float y0 = (1 - y.f) * y.inside[0] * scale, y1 = y.f * y.inside[1] * scale;
        const float wa = y0 * x0, wb = y0 * x1, wc = y1 * x0, wd = y1 * x1;
        const Texel a = source_.texel(level, x.first, y.first);
        const Texel b = source_.texel(level, x.second, y.first);
        const Texel c = source_.texel(level, x.first, y.second);
        const Texel d = source_.texel(level, x.second, y.second);
        for (std::size_t k = 0; k < 4; ++k)
            sum[k] += (wa * a[k] + wb * b[k]) + (wc * c[k] + wd * d[k]);
    }

    void add_bicubic(int level, float u, float v, float scale, Texel& sum) noexcept {
        int xs[4], ys[4];
        float wx[4], wy[4];
        cubic_taps(u, source_.width(level), wrap_u_, xs, wx);
        cubic_taps(1 - v, source_.height(level), wrap_v_, ys, wy);
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t i = 0; i < 4; ++i) {
                const float w = wx[i] * wy[j] * scale;
                if (w == 0) continue;
                const Texel t = source_.texel(level, xs[i], ys[j]);
                for (std::size_t k = 0; k < 4; ++k) sum[k] += w * t[k];
            }
    }

    static void cubic_taps(float u, int n, Wrap wrap, int (&at)[4], float (&w)[4]) noexcept {
        const float x = u * static_cast<float>(n) - 0.5f, floor_x = std::floor(x);
        const int first = static_cast<int>(floor_x) - 1;
        bspline_weights(x - floor_x, w);
        for (int i = 0; i < 4; ++i) {
            float inside = 1;
            at[i] = wrap_far(first + i, n, wrap, inside);
            w[i] *= inside;
        }
    }

    /// Fajardo et al. 2023: a texel drawn with the filter's weights has the filter's value as its
    /// mean. What lies outside of a black border is drawn too, as nothing. Textures of one place
    /// are drawn alike, so that maps of one size stay together: Pharr et al. 2024.
    void one_texel(const LevelPair& l, float u, float v, std::uint32_t seed, Texel& sum) noexcept {
        std::uint32_t h = hash_combine(hash_combine(seed, std::bit_cast<std::uint32_t>(u)),
                                       std::bit_cast<std::uint32_t>(v));
        const auto below = [&h](float share) {
            h = hash_u32(h + 0x9e3779b9u);
            return static_cast<float>(h >> 8) * 0x1p-24f < share;
        };
        const int level = below(l.f) ? l.base + 1 : l.base;
        const Taps x = find_taps(u, source_.width(level), wrap_u_);
        const Taps y = find_taps(1 - v, source_.height(level), wrap_v_);
        const bool right = below(x.f), low = below(y.f);
        if (x.inside[right] * y.inside[low] > 0)
            sum = source_.texel(level, right ? x.second : x.first, low ? y.second : y.first);
    }

    Source& source_;
    Wrap wrap_u_, wrap_v_;
};

}  // namespace tessera
