#include "renderer/core/distribution.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tessera {
namespace {

double sane(double w) { return std::isfinite(w) && w > 0 ? w : 0.0; }

// Writes the n + 1 cumulative shares of weights; returns their sum. All zero: uniform shares, sum
// 0.
double cumulate(std::span<const double> weights, float* out) {
    const std::size_t n = weights.size();
    double sum = 0;
    for (double w : weights) sum += sane(w);
    double run = 0;
    for (std::size_t i = 0; i < n; ++i) {
        out[i] = static_cast<float>(sum > 0 ? run / sum
                                            : static_cast<double>(i) / static_cast<double>(n));
        run += sane(weights[i]);
    }
    out[n] = 1.0f;
    return sum;
}

struct Inverted {
    int index;
    float position;  // within the cell, [0, 1)
    float density;   // share of the cell times the number of cells
};

// For each n-th of the unit interval, the cell in which it starts.
void make_guide(const float* cdf, int n, std::int32_t* guide) {
    int i = 0;
    for (int k = 0; k < n; ++k) {
        const float u = static_cast<float>(k) / static_cast<float>(n);
        while (i < n - 1 && cdf[i + 1] <= u) ++i;
        guide[k] = i;
    }
}

Inverted invert(const float* cdf, const std::int32_t* guide, int n, float u) {
    int i = guide[std::min(static_cast<int>(u * static_cast<float>(n)), n - 1)];
    while (i > 0 && cdf[i] > u) --i;  // rounding of the product
    while (i < n - 1 && cdf[i + 1] <= u) ++i;
    const float share = cdf[i + 1] - cdf[i];
    const float position = share > 0.0f ? (u - cdf[i]) / share : 0.5f;
    return {i, std::min(position, 0x1.fffffep-1f), share * static_cast<float>(n)};
}

}  // namespace

AliasTable::AliasTable(std::span<const double> weights)
    : cells_(weights.size()), count_(static_cast<float>(weights.size())) {
    const std::size_t n = weights.size();
    double sum = 0;
    for (double w : weights) sum += sane(w);
    std::vector<double> scaled(n);
    std::vector<std::uint32_t> small, large;
    for (std::size_t i = 0; i < n; ++i) {
        const double p = sum > 0 ? sane(weights[i]) / sum : 1.0 / static_cast<double>(n);
        cells_[i].probability = static_cast<float>(p);
        cells_[i].alias = static_cast<std::uint32_t>(i);
        scaled[i] = p * static_cast<double>(n);
        (scaled[i] < 1.0 ? small : large).push_back(static_cast<std::uint32_t>(i));
    }
    while (!small.empty() && !large.empty()) {
        const std::uint32_t s = small.back(), l = large.back();
        small.pop_back();
        cells_[s].keep = static_cast<float>(scaled[s]);
        cells_[s].alias = l;
        scaled[l] -= 1.0 - scaled[s];
        if (scaled[l] < 1.0) {
            large.pop_back();
            small.push_back(l);
        }
    }
    // What is left over differs from a full cell by rounding only, unless its weight is zero.
    for (std::uint32_t i : small) cells_[i].keep = cells_[i].probability > 0.0f ? 1.0f : 0.0f;
}

AliasTable::Pick AliasTable::sample(float u) const noexcept {
    const float scaled = u * count_;
    const auto i = static_cast<std::uint32_t>(static_cast<int>(std::min(scaled, count_ - 1.0f)));
    const float within = std::min(scaled - static_cast<float>(i), 0x1.fffffep-1f);
    const Cell& cell = cells_[i];
    if (within < cell.keep) return {i, cell.probability, within / cell.keep};
    const float rest = (within - cell.keep) / (1.0f - cell.keep);
    return {cell.alias, cells_[cell.alias].probability, std::min(rest, 0x1.fffffep-1f)};
}

Distribution2D::Distribution2D(int width, int height, std::span<const double> weights)
    : width_(width),
      height_(height),
      rows_(height + 1),
      cells_(std::size_t(width + 1) * height),
      row_guide_(height),
      cell_guide_(std::size_t(width) * height) {
    std::vector<double> row_sums(height);
    for (int y = 0; y < height; ++y) {
        float* row = &cells_[std::size_t(y) * (width + 1)];
        row_sums[y] = cumulate(weights.subspan(std::size_t(y) * width, width), row);
        make_guide(row, width, &cell_guide_[std::size_t(y) * width]);
    }
    mean_ = cumulate(row_sums, rows_.data()) / (static_cast<double>(width) * height);
    make_guide(rows_.data(), height, row_guide_.data());
}

Distribution2D::Sample Distribution2D::sample(Vec2f u) const noexcept {
    const Inverted y = invert(rows_.data(), row_guide_.data(), height_, u.y);
    const Inverted x = invert(&cells_[std::size_t(y.index) * (width_ + 1)],
                              &cell_guide_[std::size_t(y.index) * width_], width_, u.x);
    return {{(static_cast<float>(x.index) + x.position) / static_cast<float>(width_),
             (static_cast<float>(y.index) + y.position) / static_cast<float>(height_)},
            x.density * y.density};
}

float Distribution2D::pdf(Vec2f uv) const noexcept {
    const int x = std::clamp(static_cast<int>(uv.x * static_cast<float>(width_)), 0, width_ - 1);
    const int y = std::clamp(static_cast<int>(uv.y * static_cast<float>(height_)), 0, height_ - 1);
    const float* row = &cells_[std::size_t(y) * (width_ + 1)];
    return (row[x + 1] - row[x]) * static_cast<float>(width_) * (rows_[y + 1] - rows_[y]) *
           static_cast<float>(height_);
}

}  // namespace tessera
