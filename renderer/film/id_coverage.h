#pragma once
// How many samples of each pixel met which thing.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tessera {

/// Samples that met a thing. Keys are small numbers, the more important thing the smaller.
struct KeyCount {
    std::uint32_t key = 0, count = 0;
    bool operator==(const KeyCount&) const = default;
};

/// All of an IdCoverage in plain arrays, the same for the same counts in whatever order they came.
struct IdCoverageState {
    std::vector<std::uint8_t> sizes;                 // per pixel: its keys
    std::vector<std::uint32_t> keys, counts;         // pixel after pixel, keys ascending
    std::vector<std::uint32_t> dropped_at, dropped;  // pixels that dropped samples, and how many
    bool operator==(const IdCoverageState&) const = default;
};

/// Exact for pixels of up to kMaxKeys things. Of more the kMaxKeys with the smallest keys are kept,
/// with exact counts still, and the samples of the others are counted as dropped: a choice by the
/// keys alone, so that the same samples leave the same state however they were split and merged.
/// One thread at a time per pixel; no locks.
class IdCoverage {
public:
    static constexpr std::size_t kMaxKeys = 128;
    static constexpr std::size_t kBytesOfOneName = 16;  // of a pixel that sees no other

    explicit IdCoverage(std::size_t pixels) : pixels_(pixels) {}

    std::size_t pixels() const noexcept { return pixels_.size(); }
    void add(std::size_t pixel, std::uint32_t key, std::uint32_t count = 1) noexcept;
    /// Adds what a pixel of another saw, as of a range of samples or a crop rendered apart.
    void merge(std::size_t pixel, const IdCoverage& other, std::size_t from) noexcept;

    /// Writes the pixel's counts, unordered; returns how many there are.
    std::size_t counts(std::size_t pixel, std::span<KeyCount, kMaxKeys> out) const noexcept;
    std::uint32_t dropped(std::size_t pixel) const noexcept {
        return pixels_[pixel].more ? pixels_[pixel].more->dropped : 0;
    }

    IdCoverageState state() const;
    /// Nothing if the arrays contradict each other or a key is not below key_limit.
    static std::optional<IdCoverage> from(const IdCoverageState& state, std::uint32_t key_limit);
    std::size_t bytes() const noexcept;

private:
    // Most pixels see one thing and need no more than this.
    struct More {
        std::uint32_t dropped = 0;
        std::vector<KeyCount> counts;
    };
    struct Pixel {
        KeyCount first;
        std::unique_ptr<More> more;
    };

    static void add_more(Pixel& pixel, KeyCount added);

    std::vector<Pixel> pixels_;
};

}  // namespace tessera
