#pragma once
// A line of a deep file, as it is stored there: every sample's colour and opacity of its own.

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/api/deep.h"

namespace tessera {

struct DeepValue {
    float z = 0, z_back = 0;
    std::array<float, 4> rgba{};  // premultiplied
    bool operator==(const DeepValue&) const = default;
};

struct DeepLine {
    std::vector<std::uint32_t> counts;  // per pixel
    std::vector<DeepValue> values;      // pixel after pixel
    bool operator==(const DeepLine&) const = default;
};

/// Appends a pixel's samples, nearest first, as shares of beauty turned into what `over` makes
/// beauty of again: w / (1 - all w in front), rounded to halves if asked for. What rounding takes
/// from one sample is given to the next, so that it does not add up.
void append_over(std::span<const DeepSample> shares, bool half, DeepLine& out, WriteReport& report);

}  // namespace tessera
