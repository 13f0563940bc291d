#pragma once
// Some lines of a layered picture in the types of the file: a plane of halves or floats per
// channel.

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/api/image.h"

namespace tessera {

struct ExrChannel {
    std::string name;  // in the file
    bool half = false;
    const Layer* layer = nullptr;
    int index = 0;        // channel of the layer
    float limit = 65504;  // halves beyond it are clamped
};

class ExrStrip {
public:
    ExrStrip(const std::vector<ExrChannel>& channels, const PixelWindow& window);

    /// A multiple of a ZIP chunk, enough of them to keep every thread at work.
    static constexpr int kMaxLines = 256;

    /// Converts lines y0 <= y < y1 (at most kMaxLines): non-finite values become 0, halves are
    /// clamped to the channel's limit, both counted in report.
    void fill(int y0, int y1, WriteReport& report);
    /// Zeroes all planes.
    void clear();

    std::size_t element_bytes(std::size_t channel) const { return channels_[channel].half ? 2 : 4; }
    /// First line of a channel's plane; lines follow each other without gaps.
    char* plane(std::size_t channel) { return bytes_.data() + offsets_[channel]; }
    const std::vector<char>& bytes() const noexcept { return bytes_; }

private:
    std::vector<ExrChannel> channels_;
    PixelWindow window_;
    std::vector<std::size_t> offsets_;
    std::vector<char> bytes_;
};

}  // namespace tessera
