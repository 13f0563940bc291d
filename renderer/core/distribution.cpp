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
    float position;  // within the cell, [0, 1)
    float density;   // share of the cell times the number of cells
};

// The last of n cells that starts at or below u, for each lane in its own cumulative. No branch
// depends on what is found, and the lanes' searches run side by side.
template <int N>
void find_cells(const float* const (&cdf)[N], int n, const float (&u)[N], int (&out)[N]) {
    for (int& first : out) first = 0;
    while (n > 1) {
        const int half = n / 2;
        for (int lane = 0; lane < N; ++lane)
            out[lane] += cdf[lane][out[lane] + half] <= u[lane] ? half : 0;
        n -= half;
    }
}

Inverted within(const float* cdf, int i, int n, float u) {
    const float share = cdf[i + 1] - cdf[i];
    const float position = share > 0.0f ? (u - cdf[i]) / share : 0.5f;
    return {std::min(position, 0x1.fffffep-1f), share * static_cast<float>(n)};
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

Distribution2D::Distribution2D(int width, int height, std::span<const double> weights)
    : width_(width), height_(height), rows_(height + 1), cells_(std::size_t(width + 1) * height) {
    std::vector<double> row_sums(height);
    for (int y = 0; y < height; ++y) {
        float* row = &cells_[std::size_t(y) * (width + 1)];
        row_sums[y] = cumulate(weights.subspan(std::size_t(y) * width, width), row);
    }
    mean_ = cumulate(row_sums, rows_.data()) / (static_cast<double>(width) * height);
}

template <int N>
void Distribution2D::invert(const float (&ux)[N], const float (&uy)[N], float (&x)[N],
                            float (&y)[N], float (&pdf)[N]) const noexcept {
    const float* table[N];
    int row[N], cell[N];
    for (int i = 0; i < N; ++i) table[i] = rows_.data();
    find_cells(table, height_, uy, row);
    for (int i = 0; i < N; ++i) table[i] = &cells_[std::size_t(row[i]) * (width_ + 1)];
    find_cells(table, width_, ux, cell);
    for (int i = 0; i < N; ++i) {
        const Inverted down = within(rows_.data(), row[i], height_, uy[i]);
        const Inverted across = within(table[i], cell[i], width_, ux[i]);
        x[i] = (static_cast<float>(cell[i]) + across.position) / static_cast<float>(width_);
        y[i] = (static_cast<float>(row[i]) + down.position) / static_cast<float>(height_);
        pdf[i] = across.density * down.density;
    }
}

Distribution2D::Sample Distribution2D::sample(Vec2f u) const noexcept {
    float x[1], y[1], pdf[1];
    invert<1>({u.x}, {u.y}, x, y, pdf);
    return {{x[0], y[0]}, pdf[0]};
}

void Distribution2D::sample(const SamplePairs& u, SamplePairs& uv,
                            float (&pdf)[kLanes]) const noexcept {
    invert(u.x, u.y, uv.x, uv.y, pdf);
}

float Distribution2D::pdf(Vec2f uv) const noexcept {
    const int x = std::clamp(static_cast<int>(uv.x * static_cast<float>(width_)), 0, width_ - 1);
    const int y = std::clamp(static_cast<int>(uv.y * static_cast<float>(height_)), 0, height_ - 1);
    const float* row = &cells_[std::size_t(y) * (width_ + 1)];
    return (row[x + 1] - row[x]) * static_cast<float>(width_) * (rows_[y + 1] - rows_[y]) *
           static_cast<float>(height_);
}

}  // namespace tessera
