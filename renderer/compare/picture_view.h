#pragma once
// The pixels of one layer as the metrics see them.

#include <cstddef>
#include <span>

namespace tessera {

/// Rows from the top, channels interleaved: values[(y * width + x) * channels + c].
struct PictureView {
    int width = 0, height = 0, channels = 0;
    std::span<const float> values;

    std::size_t pixels() const noexcept {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    std::span<const float> pixel(std::size_t i) const noexcept {
        const auto n = static_cast<std::size_t>(channels);
        return values.subspan(i * n, n);
    }
};

}  // namespace tessera
