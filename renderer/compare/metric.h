#pragma once
// The numbers that a comparison gives, by name.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace tessera {

enum class Metric : std::uint8_t {
    rmse,
    relmse,
    trimmed_relmse,
    psnr,
    ssim,
    flip,
    max_abs,
    bias,
    different,
    non_finite,
};
inline constexpr std::size_t kMetrics = 10;

template <class T>
using PerMetric = std::array<T, kMetrics>;

/// "trimmed_relmse", in files and options.
std::string_view name_of(Metric metric) noexcept;
std::optional<Metric> metric_named(std::string_view name) noexcept;
/// Whether less of it is closer to the reference: of all but PSNR and SSIM.
bool less_is_closer(Metric metric) noexcept;
/// Whether pixels that are not finite are left out of it.
bool needs_finite(Metric metric) noexcept;

}  // namespace tessera
