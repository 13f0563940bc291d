#pragma once
// Whether parts of a picture make a whole.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// Samples first to last-1 of the pixels of a window.
struct SampleBox {
    PixelWindow window;
    int first = 0, last = 0;
    bool operator==(const SampleBox&) const = default;
};

/// "samples 0:16 of pixels 0,0,48,32"
std::string to_string(const SampleBox& box);

bool is_empty(const SampleBox& box);
SampleBox intersection(const SampleBox& a, const SampleBox& b);
/// The smallest box around all; of none an empty one.
SampleBox bounds(std::span<const SampleBox> boxes);
/// Two that have samples in common.
std::optional<std::pair<std::size_t, std::size_t>> overlap(std::span<const SampleBox> boxes);
/// What `whole` has and no part: boxes that do not overlap.
std::vector<SampleBox> missing(const SampleBox& whole, std::span<const SampleBox> parts);

}  // namespace tessera
