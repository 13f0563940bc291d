#include "renderer/image/exr_strip.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tessera {
namespace {

struct ToFloat {
    using Value = float;
    static float convert(float value, float, WriteReport&) { return value; }
};

struct ToHalf {
    using Value = half;
    static half convert(float value, float limit, WriteReport& report) {
        if (std::abs(value) > limit) {
            ++report.clamped;
            value = std::copysign(limit, value);
        }
        return half(value);
    }
};

template <class To>
void convert(const float* from, std::size_t stride, std::size_t count, char* to, float limit,
             WriteReport& report) {
    for (std::size_t i = 0; i < count; ++i) {
        float value = from[i * stride];
        if (!std::isfinite(value)) {
            ++report.non_finite;
            value = 0;
        }
        const typename To::Value stored = To::convert(value, limit, report);
        std::memcpy(to + i * sizeof stored, &stored, sizeof stored);
    }
}

}  // namespace

ExrStrip::ExrStrip(const std::vector<ExrChannel>& channels, const PixelWindow& window)
    : channels_(channels), window_(window) {
    const auto lines = static_cast<std::size_t>(std::min(kMaxLines, window.height()));
    std::size_t total = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        offsets_.push_back(total);
        total += lines * static_cast<std::size_t>(window.width()) * element_bytes(c);
    }
    bytes_.resize(total);
}

void ExrStrip::fill(int y0, int y1, WriteReport& report) {
    const auto width = static_cast<std::size_t>(window_.width());
    const std::size_t first = static_cast<std::size_t>(y0 - window_.y0) * width;
    const std::size_t count = static_cast<std::size_t>(y1 - y0) * width;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        const ExrChannel& channel = channels_[c];
        const std::size_t stride = channel.layer->channels.size();
        const float* from =
            channel.layer->pixels.data() + first * stride + static_cast<std::size_t>(channel.index);
        if (channel.half)
            convert<ToHalf>(from, stride, count, plane(c), channel.limit, report);
        else
            convert<ToFloat>(from, stride, count, plane(c), channel.limit, report);
    }
}

void ExrStrip::clear() { std::fill(bytes_.begin(), bytes_.end(), char(0)); }

}  // namespace tessera
