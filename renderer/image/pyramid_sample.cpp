#include <half.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/pyramid.h"
#include "renderer/image/texel_filter.h"

namespace tessera {
namespace {

struct Byte {
    const std::uint8_t* data;
    const float* color;
    const float* alpha;
    explicit Byte(const Pyramid& p)
        : data(p.bytes.data()), color(p.color_table), alpha(p.alpha_table) {}
    template <int kChannels>
    float get(std::size_t at, std::size_t c) const noexcept {
        const bool is_alpha = (kChannels == 2 || kChannels == 4) && c == kChannels - 1;
        return (is_alpha ? alpha : color)[data[at]];
    }
};

struct Unorm16 {
    const std::uint16_t* data;
    explicit Unorm16(const Pyramid& p) : data(p.words.data()) {}
    template <int kChannels>
    float get(std::size_t at, std::size_t) const noexcept {
        return static_cast<float>(data[at]) * (1.0f / 65535.0f);
    }
};

struct Half {
    const std::uint16_t* data;
    explicit Half(const Pyramid& p) : data(p.words.data()) {}
    template <int kChannels>
    float get(std::size_t at, std::size_t) const noexcept {
        return imath_half_to_float(data[at]);
    }
};

/// Adds scale times the bilinear value to sum.
template <class Store, int kChannels>
[[gnu::always_inline]] inline void add_bilinear(const Pyramid& p, std::size_t level, float u,
                                                float v, Wrap wrap_u, Wrap wrap_v, float scale,
                                                Texel& sum) noexcept {
    const Store store(p);
    const Pyramid::Level& l = p.levels[level];
    const Taps x = find_taps(u, l.width, wrap_u);
    const Taps y = find_taps(1 - v, l.height, wrap_v);
    const std::size_t row0 = l.first + l.row(y.first), row1 = l.first + l.row(y.second);
    const std::size_t column0 = l.column(x.first), column1 = l.column(x.second);
    const std::size_t a = (row0 + column0) * kChannels, b = (row0 + column1) * kChannels;
    const std::size_t c = (row1 + column0) * kChannels, d = (row1 + column1) * kChannels;
    const float x0 = (1 - x.f) * x.inside[0], x1 = x.f * x.inside[1];
    const float y0 = (1 - y.f) * y.inside[0] * scale, y1 = y.f * y.inside[1] * scale;
    const float wa = y0 * x0, wb = y0 * x1, wc = y1 * x0, wd = y1 * x1;
    for (std::size_t k = 0; k < kChannels; ++k) {
        const float top = wa * store.template get<kChannels>(a + k, k) +
                          wb * store.template get<kChannels>(b + k, k);
        const float bottom = wc * store.template get<kChannels>(c + k, k) +
                             wd * store.template get<kChannels>(d + k, k);
        sum[k] += top + bottom;
    }
}

template <class Store, int kChannels>
Texel trilinear(const Pyramid& p, float u, float v, float level, Wrap wrap_u,
                Wrap wrap_v) noexcept {
    Texel sum{0, 0, 0, 0};
    const auto last = static_cast<float>(p.levels.size() - 1);
    const float clamped = level > 0 ? std::min(level, last) : 0.0f;
    const auto base = static_cast<std::size_t>(clamped);
    const float f = clamped - static_cast<float>(base);
    add_bilinear<Store, kChannels>(p, base, u, v, wrap_u, wrap_v, 1 - f, sum);
    if (f > 0) add_bilinear<Store, kChannels>(p, base + 1, u, v, wrap_u, wrap_v, f, sum);
    if constexpr (kChannels == 1) return {sum[0], sum[0], sum[0], 1};
    if constexpr (kChannels == 2) return {sum[0], sum[0], sum[0], sum[1]};
    if constexpr (kChannels == 3) return {sum[0], sum[1], sum[2], 1};
    return sum;
}

/// Single texels, for the filters that are not in the loop of every scene.
template <class Store, int kChannels>
class PyramidTexels {
public:
    explicit PyramidTexels(const Pyramid& p) noexcept : p_(p), store_(p) {}
    int levels() const noexcept { return static_cast<int>(p_.levels.size()); }
    int width(int level) const noexcept { return at(level).width; }
    int height(int level) const noexcept { return at(level).height; }
    static bool has_alpha() noexcept { return kChannels == 2 || kChannels == 4; }

    Texel texel(int level, int x, int y) const noexcept {
        const Pyramid::Level& l = at(level);
        const std::size_t i = (l.first + l.row(y) + l.column(x)) * kChannels;
        const auto get = [&](std::size_t k) { return store_.template get<kChannels>(i + k, k); };
        if constexpr (kChannels == 1) return {get(0), get(0), get(0), 1};
        if constexpr (kChannels == 2) return {get(0), get(0), get(0), get(1)};
        if constexpr (kChannels == 3) return {get(0), get(1), get(2), 1};
        if constexpr (kChannels == 4) return {get(0), get(1), get(2), get(3)};
    }

private:
    const Pyramid::Level& at(int level) const noexcept {
        return p_.levels[static_cast<std::size_t>(level)];
    }
    const Pyramid& p_;
    Store store_;
};

template <class Store>
Texel by_channels(const Pyramid& p, float u, float v, float level, Wrap wrap_u,
                  Wrap wrap_v) noexcept {
    switch (p.channels) {
        case 1:
            return trilinear<Store, 1>(p, u, v, level, wrap_u, wrap_v);
        case 2:
            return trilinear<Store, 2>(p, u, v, level, wrap_u, wrap_v);
        case 3:
            return trilinear<Store, 3>(p, u, v, level, wrap_u, wrap_v);
        default:
            return trilinear<Store, 4>(p, u, v, level, wrap_u, wrap_v);
    }
}

struct FilteredRead {
    TextureFilter filter;
    float u, v, level;
    Wrap wrap_u, wrap_v;
    std::uint32_t seed;
};

template <class Store, int kChannels>
Texel filtered(const Pyramid& p, const FilteredRead& r) noexcept {
    PyramidTexels<Store, kChannels> texels(p);
    return TexelFilter(texels, r.wrap_u, r.wrap_v)(r.filter, r.u, r.v, r.level, r.seed);
}

template <class Store>
Texel filtered_by_channels(const Pyramid& p, const FilteredRead& r) noexcept {
    switch (p.channels) {
        case 1:
            return filtered<Store, 1>(p, r);
        case 2:
            return filtered<Store, 2>(p, r);
        case 3:
            return filtered<Store, 3>(p, r);
        default:
            return filtered<Store, 4>(p, r);
    }
}

}  // namespace

float fold(float u, Wrap wrap) noexcept {
    if (wrap == Wrap::repeat) return u - std::floor(u);
    if (wrap == Wrap::mirror) return u - 2 * std::floor(u * 0.5f);
    return std::clamp(u, -1.0f, 2.0f);
}

Texel sample_pyramid(const Pyramid& pyramid, float u, float v, float level, Wrap wrap_u,
                     Wrap wrap_v) noexcept {
    u = fold(u, wrap_u);
    v = fold(v, wrap_v);
    switch (pyramid.type) {
        case TexelType::byte:
            return by_channels<Byte>(pyramid, u, v, level, wrap_u, wrap_v);
        case TexelType::unorm16:
            return by_channels<Unorm16>(pyramid, u, v, level, wrap_u, wrap_v);
        case TexelType::half:
            return by_channels<Half>(pyramid, u, v, level, wrap_u, wrap_v);
    }
    return {0, 0, 0, 1};
}

Texel filter_pyramid(const Pyramid& pyramid, TextureFilter filter, float u, float v, float level,
                     Wrap wrap_u, Wrap wrap_v, std::uint32_t seed) noexcept {
    const FilteredRead r{filter, fold(u, wrap_u), fold(v, wrap_v), level, wrap_u, wrap_v, seed};
    switch (pyramid.type) {
        case TexelType::byte:
            return filtered_by_channels<Byte>(pyramid, r);
        case TexelType::unorm16:
            return filtered_by_channels<Unorm16>(pyramid, r);
        case TexelType::half:
            return filtered_by_channels<Half>(pyramid, r);
    }
    return {0, 0, 0, 1};
}

}  // namespace tessera
