#include "renderer/compare/metric.h"

#include <algorithm>

namespace tessera {
namespace {

constexpr PerMetric<std::string_view> kNames{"rmse",      "relmse",    "trimmed_relmse", "psnr",
                                             "ssim",      "flip",      "max_abs",        "bias",
                                             "different", "non_finite"};

}  // namespace

std::string_view name_of(Metric metric) noexcept {
    return kNames[static_cast<std::size_t>(metric)];
}

std::optional<Metric> metric_named(std::string_view name) noexcept {
    const auto at = std::find(kNames.begin(), kNames.end(), name);
    if (at == kNames.end()) return std::nullopt;
    return static_cast<Metric>(at - kNames.begin());
}

bool less_is_closer(Metric metric) noexcept {
    return metric != Metric::psnr && metric != Metric::ssim;
}

bool needs_finite(Metric metric) noexcept {
    return metric != Metric::different && metric != Metric::non_finite;
}

}  // namespace tessera
