#pragma once
// The picture itself: sums of what camera paths brought, in one or by replicates.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "renderer/core/sum.h"
#include "renderer/core/vec.h"
#include "renderer/core/zeroed.h"
#include "renderer/error/replicates.h"
#include "renderer/film/probes.h"

namespace tessera {

/// What one camera path gives to its pixel.
struct PathSample {
    Color radiance{0.0f};
    float alpha = 0;  // 1 where the camera ray hit something
};

/// Pixels by number, rows from the top. One thread at a time per pixel; no locks.
class Beauty {
public:
    /// probes_seed: of the probes' places; nothing: no replicates, no probes.
    Beauty(const PixelWindow& window, std::optional<std::uint64_t> probes_seed);

    void add(std::size_t pixel, std::uint32_t sample, const PathSample& s) noexcept;
    /// Adds what a pixel of another has.
    void merge(std::size_t pixel, const Beauty& other, std::size_t from) noexcept;
    void merge_probes(const Beauty& other);

    std::span<const PixelCounts> counts() const noexcept { return counts_; }
    /// Over all samples.
    Sum sum(std::size_t pixel, std::size_t channel) const noexcept;
    bool has_replicates() const noexcept { return probes_.has_value(); }
    /// Empty without replicates.
    ReplicateView replicates() const noexcept;
    /// R, G, B of a pixel; 0 while a replicate has no samples. calibration: of squared errors.
    void standard_error(std::size_t pixel, double calibration, float* rgb) const noexcept;
    Probes* probes() noexcept { return probes_ ? &*probes_ : nullptr; }

    /// Whether samples can be added to counts that were read from a file.
    bool counts_make_sense() const noexcept;
    std::size_t bytes() const noexcept;
    /// What checkpoints save.
    ZeroedArray<Sum>& sums() noexcept { return sums_; }
    ZeroedArray<PixelCounts>& counts() noexcept { return counts_; }
    static std::uint64_t sums_of_pixel(bool replicates) {
        return replicates ? ReplicateView::kChannels * kReplicates : ReplicateView::kChannels;
    }

private:
    void lengthen_runs(std::size_t pixel, std::uint32_t log_run) noexcept;
    Sum* at(std::size_t pixel, std::size_t replicate) noexcept {
        return sums_.data() + first(pixel, replicate);
    }
    std::size_t first(std::size_t pixel, std::size_t replicate) const noexcept {
        return 3 * (probes_ ? pixel * kReplicates + replicate : pixel);
    }

    PixelWindow window_;
    std::optional<Probes> probes_;
    ZeroedArray<Sum> sums_;  // [pixel][replicate][channel], or [pixel][channel]
    ZeroedArray<PixelCounts> counts_;
};

}  // namespace tessera
