#pragma once
// A picture as the mean of independent replicates of itself: each has scrambles of its own, so that
// how they differ says how wrong their mean is, which the samples of one scramble cannot, for they
// depend on each other. Kollig and Keller, "Efficient Multidimensional Sampling", CGF 21(3), 2002.

#include <cstdint>
#include <span>

#include "renderer/core/sampler.h"
#include "renderer/core/sum.h"

namespace tessera {

/// What a pixel has: samples by replicate, and how many of them hit something.
struct PixelCounts {
    std::uint32_t samples[kReplicates]{};
    std::uint32_t hits = 0;

    std::uint32_t total() const noexcept {
        std::uint32_t sum = 0;
        for (const std::uint32_t n : samples) sum += n;
        return sum;
    }
    void add(const PixelCounts& o) noexcept {
        for (int r = 0; r < kReplicates; ++r) samples[r] += o.samples[r];
        hits += o.hits;
    }
};

/// Sums over each replicate's samples: [pixel][replicate][channel], rows from the top.
struct ReplicateView {
    static constexpr int kChannels = 3;
    int width = 0, height = 0;
    std::span<const Sum> sums;
    std::span<const PixelCounts> counts;
};

}  // namespace tessera
