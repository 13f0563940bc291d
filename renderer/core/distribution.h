#pragma once
// Piecewise-constant distributions over tables. Built in double; sums are exact enough for any
// table we meet.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/ray.h"
#include "renderer/core/sampler.h"
#include "renderer/core/vec.h"

namespace tessera {

/// Picks an index with probability proportional to its weight, in constant time.
/// Walker 1977, built as by Vose, "A Linear Algorithm for Generating Random Numbers...", 1991.
class AliasTable {
public:
    struct Pick {
        std::size_t index;
        float probability;
        float remainder;  // u rescaled to [0,1) for further use
    };

    AliasTable() = default;
    /// Weights: finite and >= 0 (others count as 0). All zero: uniform.
    explicit AliasTable(std::span<const double> weights);

    Pick sample(float u) const noexcept;
    /// The same for tables of any size: `more` stands below the 24 bits of u, which alone are too
    /// few where cells count by the hundred thousand.
    Pick sample(float u, std::uint32_t more) const noexcept;
    float probability(std::size_t index) const noexcept { return cells_[index].probability; }
    std::size_t size() const noexcept { return cells_.size(); }
    std::size_t bytes() const noexcept { return cells_.size() * sizeof(Cell); }

private:
    struct Cell {
        float keep = 1;  // share of the cell that stays with its own index
        std::uint32_t alias = 0;
        float probability = 0;
    };
    Pick pick(std::uint32_t cell, float within) const noexcept;

    std::vector<Cell> cells_;
    float count_ = 0;  // of cells, as sample() wants it
};

/// A density over the unit square from a width x height table of weights, sampled by inversion
/// (marginal in y, then conditional in x), so that stratified input stays stratified.
class Distribution2D {
public:
    struct Sample {
        Vec2f uv;
        float pdf;  // per unit area of the square
    };

    Distribution2D() = default;
    Distribution2D(int width, int height, std::span<const double> weights);

    Sample sample(Vec2f u) const noexcept;
    /// The same for sixteen points; lanes that are not wanted may hold anything finite.
    void sample(const SamplePairs& u, SamplePairs& uv, float (&pdf)[kLanes]) const noexcept;
    float pdf(Vec2f uv) const noexcept;
    /// Mean weight; 0 means that nothing can be sampled.
    double mean() const noexcept { return mean_; }
    bool empty() const noexcept { return rows_.empty(); }
    std::size_t bytes() const noexcept { return (rows_.size() + cells_.size()) * sizeof(float); }

private:
    template <int N>
    void invert(const float (&ux)[N], const float (&uy)[N], float (&x)[N], float (&y)[N],
                float (&pdf)[N]) const noexcept;

    int width_ = 0, height_ = 0;
    double mean_ = 0;
    std::vector<float> rows_;   // height_ + 1 cumulative
    std::vector<float> cells_;  // per row width_ + 1 cumulative
};

// In the header: choosing a light is one of the loop's leaves. Branch-free: which light it will be
// is what no predictor can know.
inline AliasTable::Pick AliasTable::sample(float u) const noexcept {
    const float scaled = u * count_;
    const auto i = static_cast<std::uint32_t>(static_cast<int>(std::min(scaled, count_ - 1.0f)));
    return pick(i, std::min(scaled - static_cast<float>(static_cast<int>(i)), 0x1.fffffep-1f));
}

inline AliasTable::Pick AliasTable::sample(float u, std::uint32_t more) const noexcept {
    const double fine = static_cast<double>(u) + static_cast<double>(more) * 0x1p-56;
    const double scaled = fine * static_cast<double>(cells_.size());
    const auto i = static_cast<std::uint32_t>(
        std::min(static_cast<std::int64_t>(scaled), static_cast<std::int64_t>(cells_.size()) - 1));
    return pick(i, std::min(static_cast<float>(scaled - static_cast<double>(i)), 0x1.fffffep-1f));
}

inline AliasTable::Pick AliasTable::pick(std::uint32_t i, float within) const noexcept {
    const Cell& cell = cells_[i];
    const bool own = within < cell.keep;
    const std::uint32_t index = own ? i : cell.alias;
    const float over = own ? within : within - cell.keep;
    const float width = own ? cell.keep : 1.0f - cell.keep;
    return {index, cells_[index].probability, std::min(over / width, 0x1.fffffep-1f)};
}

}  // namespace tessera
