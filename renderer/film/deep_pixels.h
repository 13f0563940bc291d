#pragma once
// Beauty apart by depth: what deep files are made of.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/api/deep.h"
#include "renderer/core/sum.h"
#include "renderer/core/vec.h"

namespace tessera {

/// All of a DeepPixels in plain arrays.
struct DeepPixelsState {
    std::vector<std::uint8_t> sizes, levels;  // per pixel: its bins, how coarse its steps are
    std::vector<std::uint32_t> keys, counts;  // pixel after pixel, keys ascending
    std::vector<float> depths;                // nearest and farthest of each bin
    std::vector<double> sums;                 // high and low of R, G, B of each bin
    bool operator==(const DeepPixelsState&) const = default;
};

/// Samples are summed up in steps of depth that are the same for all pixels: a 2048th of a power of
/// two. A pixel that sees more than kMaxDepths of them has its steps doubled until they are few
/// enough. How often is told by the set of depths alone, so that the same samples give the same
/// picture however they were split and merged (docs/decisions/011-deep-by-steps-of-depth.md).
/// One thread at a time per pixel; no locks.
class DeepPixels {
public:
    static constexpr std::size_t kMaxDepths = 32;
    static constexpr float kTolerance = 1e-3f;  // neighbours this near are joined, of their depth

    explicit DeepPixels(std::size_t pixels) : pixels_(pixels) {}

    std::size_t pixels() const noexcept { return pixels_.size(); }
    void add(std::size_t pixel, float z, Color radiance);
    /// Of a sample that hit nothing.
    void add_background(std::size_t pixel, Color radiance);
    /// Adds what a pixel of another saw, as of a range of samples or a crop rendered apart.
    void merge(std::size_t pixel, const DeepPixels& other, std::size_t from);

    /// Appends the pixel's samples, nearest first, the background last; returns how many. n: camera
    /// samples that the pixel had.
    std::uint32_t put(std::size_t pixel, std::uint32_t n, std::vector<DeepSample>& out) const;
    /// Samples that met something, and those of a bright background.
    struct Counts {
        std::uint64_t hits = 0, background = 0;
    };
    Counts counts(std::size_t pixel) const noexcept;
    /// Pixels whose steps had to be doubled.
    std::size_t crowded() const noexcept;

    DeepPixelsState state() const;
    /// Nothing if the arrays contradict each other.
    static std::optional<DeepPixels> from(const DeepPixelsState& state);
    std::size_t bytes() const noexcept;

    static constexpr std::size_t kBytesOfOneDepth = 96;  // of a pixel that sees no other

private:
    struct Bin {
        std::uint32_t key = 0, count = 0;
        float near = 0, far = 0;
        Sum rgb[3];
    };
    struct Pixel {
        std::vector<Bin> bins;  // keys ascending
        std::uint8_t level = 0;
    };

    static std::size_t depths(const Pixel& pixel) noexcept;
    static void coarsen(Pixel& pixel);
    static void add(Pixel& pixel, const Bin& added);
    static void join(Bin& to, const Bin& added) noexcept;

    std::vector<Pixel> pixels_;
};

/// Tells of pixels whose depths are coarser than the others'.
void note_crowds(const DeepPixels& deep, std::vector<std::string>& notes);

}  // namespace tessera
