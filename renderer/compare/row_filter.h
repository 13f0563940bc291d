#pragma once
// Separable filters over bands of rows: what a worker needs of a picture fits its cache.

#include <cstddef>
#include <span>
#include <vector>

namespace tessera {

/// One component of some rows.
struct Rows {
    int width = 0, count = 0;
    std::vector<float> values;

    void resize(int new_width, int new_count);
    float* row(int y) noexcept { return values.data() + offset(y); }
    const float* row(int y) const noexcept { return values.data() + offset(y); }

private:
    std::size_t offset(int y) const noexcept {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    }
};

/// Weights of the neighbours -radius .. radius.
using Kernel = std::vector<float>;
inline int radius_of(const Kernel& kernel) { return static_cast<int>(kernel.size() / 2); }

/// exp(-x^2 / (2 sigma^2)), of sum 1.
Kernel gaussian(double sigma, int radius);
/// Its first and second derivative; the positive weights have the sum 1, the negative ones -1.
Kernel gaussian_slope(double sigma, int radius);
Kernel gaussian_bend(double sigma, int radius);

/// out(x, y) = sum of kernel[i] in(x + i - radius, y); the pixels at the ends go on.
void filter_along_rows(const Rows& in, const Kernel& kernel, Rows& out);

/// Across the rows. `in` has `halo` rows more than `out` above and below, halo >= the radius.
void filter_across_rows(const Rows& in, const Kernel& kernel, int halo, Rows& out);

}  // namespace tessera
