#pragma once
// What a channel's values are, beside their errors.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/compare/picture_view.h"

namespace tessera {

struct ValueCounts {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    bool operator==(const ValueCounts&) const = default;
};

/// One for each channel.
std::vector<ValueCounts> count_values(const PictureView& picture);

/// Of each pixel: 1 if all its values are finite in both.
std::vector<std::uint8_t> finite_in_both(const PictureView& a, const PictureView& b);

/// Pixels with a value that is not the same. NaN is the same as NaN, 0 as -0; otherwise the bits
/// count, so that ids which are no numbers are told apart.
std::vector<std::uint8_t> differing(const PictureView& a, const PictureView& b);

}  // namespace tessera
