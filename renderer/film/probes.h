#pragma once
// Beauty of the probes' second rendering, which nothing of goes into the picture.

#include "renderer/core/sum.h"
#include "renderer/core/vec.h"
#include "renderer/core/zeroed.h"
#include "renderer/error/probe_grid.h"

namespace tessera {

class Probes {
public:
    Probes(const PixelWindow& window, std::uint64_t seed);

    const ProbeGrid& grid() const noexcept { return grid_; }
    std::uint32_t samples(std::size_t cell) const noexcept { return counts_[cell]; }
    /// One thread at a time per cell.
    void add(std::size_t cell, Color radiance) noexcept;
    /// Of the same frame and seed, its window within this one's.
    void merge(const Probes& other, const PixelWindow& other_window);

    const ZeroedArray<Sum>& sums() const noexcept { return sums_; }  // [cell][channel]
    const ZeroedArray<std::uint32_t>& counts() const noexcept { return counts_; }
    /// What checkpoints save and bring back.
    ZeroedArray<Sum>& sums() noexcept { return sums_; }
    ZeroedArray<std::uint32_t>& counts() noexcept { return counts_; }

    std::size_t bytes() const noexcept {
        return sums_.capacity() * sizeof(Sum) + counts_.capacity() * sizeof(std::uint32_t);
    }

private:
    ProbeGrid grid_;
    ZeroedArray<Sum> sums_;
    ZeroedArray<std::uint32_t> counts_;
};

}  // namespace tessera
