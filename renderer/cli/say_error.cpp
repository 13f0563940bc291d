#include "renderer/cli/say_error.h"

#include <algorithm>

#include <fmt/format.h>

#include "renderer/core/log.h"
#include "renderer/error/cause_text.h"

namespace tessera {
namespace {

std::string text_of(const char* name, const Interval& i) {
    return fmt::format("{} {:.3g} ({:.3g} to {:.3g}{})", name, i.value, i.low, i.high,
                       i.reliable ? "" : "; unreliable");
}

void add(LayeredImage& image, const std::string& name, const Interval& i) {
    const std::string key = "tessera/error/" + name;
    image.metadata.emplace_back(key, static_cast<float>(i.value));
    image.metadata.emplace_back(key + "Low", static_cast<float>(i.low));
    image.metadata.emplace_back(key + "High", static_cast<float>(i.high));
    image.metadata.emplace_back(key + "Reliable", i.reliable ? 1 : 0);
}

}  // namespace

std::string to_text(const ErrorEstimate& e) {
    if (!e.known) return "unknown: fewer than 4 samples in some pixels";
    std::string text = text_of("relMSE", e.relmse) + ", " + text_of("RMSE", e.rmse);
    for (const std::string& c : e.cautions) text += "; " + c;
    return text;
}

std::string to_text(const ErrorTarget& t) {
    return fmt::format("{} {:.3g}", t.relative ? "relMSE" : "RMSE", t.value);
}

void say_causes(const std::vector<ErrorCause>& causes) {
    constexpr double kWorthSaying = 0.1;
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(causes.size(), kMost); ++i)
        if (i == 0 || causes[i].share >= kWorthSaying) log_info("cause    " + to_text(causes[i]));
    if (!causes.empty()) log_info("remedy   " + causes.front().remedy);
}

std::string why_not_reached(const Statistics& s) {
    const Interval& i = s.error_target->relative ? s.error.relmse : s.error.rmse;
    if (!s.complete) return "the render was stopped";
    if (s.error.known && !i.reliable && i.high <= s.error_target->value)
        return "its estimate is not reliable";
    return fmt::format("{} samples a pixel or the time were used up", s.spp);
}

void add_error_metadata(LayeredImage& image, const ErrorEstimate& e) {
    if (!e.known) return;
    add(image, "relmse", e.relmse);
    add(image, "rmse", e.rmse);
    add(image, "worstTile", e.worst_tile);
    image.metadata.emplace_back("tessera/error/epsilon", static_cast<float>(e.epsilon));
}

}  // namespace tessera
