#include "renderer/converge/log_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr double kRoom = 0.04;         // of the span, at each end
constexpr double kLeastDecades = 0.6;  // that an axis spans
constexpr int kMostLabels = 7;

std::string superscript(int n) {
    static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string out = n < 0 ? "⁻" : "";
    for (const char c : std::to_string(std::abs(n))) out += kDigits[c - '0'];
    return out;
}

}  // namespace

std::string tick_text(double value) {
    const int decade = static_cast<int>(std::floor(std::log10(value) + 1e-9));
    const double lead = value / std::pow(10.0, decade);
    if (decade >= -3 && decade <= 4) return fmt::format("{:.6g}", value);
    const std::string power = "10" + superscript(decade);
    return std::fabs(lead - 1) < 1e-6 ? power : fmt::format("{:.3g}·{}", lead, power);
}

LogAxis::LogAxis(const std::vector<double>& values, double first, double last)
    : first_(first), last_(last) {
    double low = HUGE_VAL, high = 0;
    for (const double v : values) {
        if (!std::isfinite(v) || v < 1e-300) continue;
        low = std::min(low, v), high = std::max(high, v);
    }
    if (high <= 0) return;
    const double a = std::log10(low), b = std::log10(high);
    const double missing = std::max(0.0, kLeastDecades - (b - a)) / 2;
    const double room = kRoom * std::max(b - a, kLeastDecades);
    low_ = std::pow(10.0, a - missing - room);
    high_ = std::pow(10.0, b + missing + room);
}

double LogAxis::at(double value) const noexcept {
    const double inside = std::isnan(value) ? low_ : std::clamp(value, low_, high_);
    return first_ + (last_ - first_) * std::log(inside / low_) / std::log(high_ / low_);
}

std::vector<Tick> LogAxis::ticks() const {
    const int first = static_cast<int>(std::floor(std::log10(low_)));
    const int last = static_cast<int>(std::floor(std::log10(high_)));
    const double decades = std::log10(high_ / low_);
    const int every = static_cast<int>(std::ceil(decades / kMostLabels));
    std::vector<Tick> out;
    for (int decade = first; decade <= last; ++decade) {
        for (int lead = 1; lead < 10; ++lead) {
            const double v = lead * std::pow(10.0, decade);
            if (v < low_ || v > high_) continue;
            bool labelled = lead == 1 && decade % every == 0;
            if (decades < 2.2) labelled = lead == 1 || lead == 2 || lead == 5;
            if (decades < 0.9) labelled = lead != 7 && lead != 9;
            if (!labelled && decades > 4 && lead != 1) continue;
            out.push_back({v, labelled ? tick_text(v) : ""});
        }
    }
    return out;
}

}  // namespace tessera
