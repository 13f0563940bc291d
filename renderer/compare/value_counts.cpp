#include "renderer/compare/value_counts.h"

#include <bit>
#include <cmath>

namespace tessera {
namespace {

bool same_value(float a, float b) {
    const auto p = std::bit_cast<std::uint32_t>(a), q = std::bit_cast<std::uint32_t>(b);
    if (p == q) return true;
    return (std::isnan(a) && std::isnan(b)) || ((p | q) << 1) == 0;
}

template <class F>
std::vector<std::uint8_t> marked(const PictureView& a, const PictureView& b, F&& mark) {
    std::vector<std::uint8_t> out(a.pixels());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const std::span<const float> p = a.pixel(i), q = b.pixel(i);
        bool any = false;
        for (std::size_t c = 0; c < p.size(); ++c) any = any || mark(p[c], q[c]);
        out[i] = any;
    }
    return out;
}

}  // namespace

std::vector<ValueCounts> count_values(const PictureView& picture) {
    const auto channels = static_cast<std::size_t>(picture.channels);
    std::vector<ValueCounts> counts(channels);
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        const float v = picture.values[i];
        ValueCounts& n = counts[i % channels];
        n.nan += std::isnan(v);
        n.infinite += std::isinf(v);
        n.negative += v < 0;
    }
    return counts;
}

std::vector<std::uint8_t> finite_in_both(const PictureView& a, const PictureView& b) {
    std::vector<std::uint8_t> out =
        marked(a, b, [](float p, float q) { return !std::isfinite(p) || !std::isfinite(q); });
    for (std::uint8_t& v : out) v = !v;
    return out;
}

std::vector<std::uint8_t> differing(const PictureView& a, const PictureView& b) {
    return marked(a, b, [](float p, float q) { return !same_value(p, q); });
}

}  // namespace tessera
