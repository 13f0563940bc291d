#pragma once
// A picture's samples in four parts, whose differences tell its error where a single sequence's
// samples, which keep out of each other's way, do not.
//
// The points of a sequence up to a power of two are four runs of a quarter each, every one of them
// a net with scrambles of its own (Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences",
// 1995). When twice as many points come, two runs and two make one each and there is room for two
// more.

#include <bit>
#include <cstdint>
#include <span>

#include "renderer/api/scene_desc.h"
#include "renderer/core/sampler.h"
#include "renderer/core/sum.h"
#include "renderer/error/probe_grid.h"

namespace tessera {

inline constexpr int kReplicates = 4;

/// What a pixel has: samples by replicate, and how many of them hit something.
struct PixelCounts {
    std::uint32_t samples[kReplicates]{};
    std::uint32_t hits = 0;
    std::uint32_t log_run = 0;  // to base 2, of a replicate's points; point p is of p >> log_run

    std::uint32_t total() const noexcept {
        std::uint32_t sum = 0;
        for (const std::uint32_t n : samples) sum += n;
        return sum;
    }
    bool has_all() const noexcept {
        bool all = true;
        for (const std::uint32_t n : samples) all &= n > 0;
        return all;
    }
};

/// The shortest of four runs that reach a point, as PixelCounts has it.
constexpr std::uint32_t run_of(std::uint32_t point) {
    const int width = std::bit_width(point);
    return width > 2 ? static_cast<std::uint32_t>(width - 2) : 0;
}

/// Sums over the samples of the probes' second rendering: [cell][channel].
struct ProbeView {
    ProbeGrid grid;
    std::span<const Sum> sums;
    std::span<const std::uint32_t> counts;
};

/// Sums over each replicate's samples: [pixel][replicate][channel], rows from the top.
struct ReplicateView {
    static constexpr int kChannels = 3;
    PixelWindow window;  // in the frame
    std::span<const Sum> sums;
    std::span<const PixelCounts> counts;
    ProbeView probes;

    /// Of a pixel in the frame.
    std::size_t pixel(int x, int y) const noexcept {
        return static_cast<std::size_t>(y - window.y0) * static_cast<std::size_t>(window.width()) +
               static_cast<std::size_t>(x - window.x0);
    }
};

}  // namespace tessera
