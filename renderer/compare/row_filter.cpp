#include "renderer/compare/row_filter.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

template <class F>
Kernel sampled(int radius, F&& f) {
    Kernel kernel;
    for (int i = -radius; i <= radius; ++i) kernel.push_back(static_cast<float>(f(i)));
    return kernel;
}

double bell(double x, double sigma) { return std::exp(-x * x / (2 * sigma * sigma)); }

void balance(Kernel& kernel) {
    double above = 0, below = 0;
    for (const float k : kernel) (k > 0 ? above : below) += static_cast<double>(std::fabs(k));
    for (float& k : kernel)
        k = static_cast<float>(static_cast<double>(k) / (k > 0 ? above : below));
}

void add_scaled(const float* in, float weight, int count, float* out) {
    for (int x = 0; x < count; ++x) out[x] += weight * in[x];
}

}  // namespace

void Rows::resize(int new_width, int new_count) {
    width = new_width, count = new_count;
    values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(count));
}

Kernel gaussian(double sigma, int radius) {
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) sum += bell(i, sigma);
    return sampled(radius, [&](int i) { return bell(i, sigma) / sum; });
}

Kernel gaussian_slope(double sigma, int radius) {
    Kernel kernel = sampled(radius, [&](int i) { return -i * bell(i, sigma); });
    balance(kernel);
    return kernel;
}

Kernel gaussian_bend(double sigma, int radius) {
    Kernel kernel =
        sampled(radius, [&](int i) { return (i * i / (sigma * sigma) - 1) * bell(i, sigma); });
    balance(kernel);
    return kernel;
}

void filter_along_rows(const Rows& in, const Kernel& kernel, Rows& out) {
    const int radius = radius_of(kernel), width = in.width;
    out.resize(width, in.count);
    std::vector<float> padded(static_cast<std::size_t>(width + 2 * radius));
    for (int y = 0; y < in.count; ++y) {
        const float* const row = in.row(y);
        std::fill_n(padded.begin(), radius, row[0]);
        std::copy_n(row, width, padded.begin() + radius);
        std::fill_n(padded.begin() + radius + width, radius, row[width - 1]);
        std::fill_n(out.row(y), width, 0.0f);
        for (std::size_t i = 0; i < kernel.size(); ++i)
            add_scaled(padded.data() + i, kernel[i], width, out.row(y));
    }
}

void filter_across_rows(const Rows& in, const Kernel& kernel, int halo, Rows& out) {
    const int radius = radius_of(kernel);
    out.resize(in.width, in.count - 2 * halo);
    for (int y = 0; y < out.count; ++y) {
        std::fill_n(out.row(y), out.width, 0.0f);
        for (int i = 0; i <= 2 * radius; ++i)
            add_scaled(in.row(y + halo - radius + i), kernel[static_cast<std::size_t>(i)],
                       out.width, out.row(y));
    }
}

}  // namespace tessera
