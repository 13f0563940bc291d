#include "renderer/compare/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/compare/row_filter.h"

namespace tessera {
namespace {

constexpr int kRadius = kSsimWindow / 2, kBand = 32;
constexpr float kC1 = 0.01f * 0.01f, kC2 = 0.03f * 0.03f;  // for a range of 1

double luminance(std::span<const float> rgb, std::size_t pixel) {
    return 0.2126 * static_cast<double>(rgb[3 * pixel]) +
           0.7152 * static_cast<double>(rgb[3 * pixel + 1]) +
           0.0722 * static_cast<double>(rgb[3 * pixel + 2]);
}

// IEC 61966-2-1
double encode_srgb(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

enum Moment { mean_a, mean_b, square_a, square_b, product, moments };

// Sum over the windows centred on rows y0 to y1.
double band_sum(const PictureView& a, const PictureView& b, const Kernel& kernel, int y0, int y1) {
    std::array<Rows, moments> in, along, out;
    for (Rows& rows : in) rows.resize(a.width, y1 - y0 + 2 * kRadius);
    const std::size_t first =
        static_cast<std::size_t>(y0 - kRadius) * static_cast<std::size_t>(a.width);
    for (std::size_t i = 0; i < in[0].values.size(); ++i) {
        const float p = a.values[first + i], q = b.values[first + i];
        in[mean_a].values[i] = p, in[mean_b].values[i] = q;
        in[square_a].values[i] = p * p, in[square_b].values[i] = q * q;
        in[product].values[i] = p * q;
    }
    for (int m = 0; m < moments; ++m) {
        filter_along_rows(in[m], kernel, along[m]);
        filter_across_rows(along[m], kernel, kRadius, out[m]);
    }
    double sum = 0;
    for (int y = 0; y < y1 - y0; ++y) {
        for (int x = kRadius; x < a.width - kRadius; ++x) {
            const float ma = out[mean_a].row(y)[x], mb = out[mean_b].row(y)[x];
            const float va = out[square_a].row(y)[x] - ma * ma;
            const float vb = out[square_b].row(y)[x] - mb * mb;
            const float cov = out[product].row(y)[x] - ma * mb;
            // eq. 13
            sum += static_cast<double>((2 * (ma * mb) + kC1) * (2 * cov + kC2) /
                                       ((ma * ma + mb * mb + kC1) * (va + vb + kC2)));
        }
    }
    return sum;
}

}  // namespace

std::optional<double> ssim(const PictureView& a, const PictureView& b, Workers& workers) {
    if (a.width < kSsimWindow || a.height < kSsimWindow) return std::nullopt;
    const Kernel kernel = gaussian(1.5, kRadius);
    const int rows = a.height - 2 * kRadius;
    std::vector<double> sums(static_cast<std::size_t>((rows + kBand - 1) / kBand));
    workers.for_each(static_cast<int>(sums.size()), [&](int band) {
        const int y0 = kRadius + band * kBand, y1 = std::min(y0 + kBand, a.height - kRadius);
        sums[static_cast<std::size_t>(band)] = band_sum(a, b, kernel, y0, y1);
    });
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum / (static_cast<double>(rows) * (a.width - 2 * kRadius));
}

double exposure_of(std::span<const float> reference_rgb) noexcept {
    double sum = 0;
    const std::size_t pixels = reference_rgb.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) sum += luminance(reference_rgb, i);
    return sum > 0 ? 0.18 * static_cast<double>(pixels) / sum : 1;
}

std::vector<float> shown_luminance(std::span<const float> rgb, ShownAs how, double exposure) {
    std::vector<float> out(rgb.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double y = std::max(luminance(rgb, i), 0.0), exposed = exposure * y;
        const double shown = how == ShownAs::encoded ? std::min(y, 1.0) : exposed / (1 + exposed);
        out[i] = static_cast<float>(encode_srgb(shown));
    }
    return out;
}

}  // namespace tessera
