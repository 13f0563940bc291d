#include "renderer/cli/compare_limits.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "renderer/api/error.h"
#include "renderer/core/nearest_name.h"

namespace tessera {
namespace {

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    for (std::size_t m = 0; m < kMetrics; ++m) names.emplace_back(name_of(static_cast<Metric>(m)));
    return names;
}

[[noreturn]] void usage(const std::string& option, const std::string& what) {
    throw Error(ExitCode::usage, option + ": " + what);
}

double parse_value(const std::string& text, const std::string& option) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), end, value);
    if (code != std::errc() || stop != end || !std::isfinite(value))
        usage(option, "'" + text + "' is no number");
    return value;
}

const std::optional<SeedInterval>& value_of(const SideScores& side, Metric metric) {
    return side.values[static_cast<std::size_t>(metric)];
}

bool exceeds(const Limit& limit, double value) {
    return limit.above ? value > limit.value : value < limit.value;
}

// Whether the metric is one of the layer's, though nothing could be measured.
bool belongs(Metric metric, LayerContent content) {
    const bool data =
        metric == Metric::rmse || metric == Metric::max_abs || metric == Metric::non_finite;
    return content == LayerContent::colour || (content == LayerContent::data && data);
}

class LimitCheck {
public:
    LimitCheck(const Comparison& comparison, const Limit& limit, bool ignore_non_finite)
        : comparison_(comparison), limit_(limit), ignore_(ignore_non_finite) {}

    std::vector<std::string> run() {
        for (const ComparedLayer& layer : comparison_.layers) {
            if (!limit_.layer.empty() && limit_.layer != layer.title) continue;
            for (std::size_t s = 0; s < layer.sides.size(); ++s) look(layer, s);
        }
        if (!measured_)
            throw Error(ExitCode::usage,
                        limit_.text + ": no layer that was compared is measured by it");
        return std::move(lines_);
    }

private:
    void look(const ComparedLayer& layer, std::size_t side) {
        const SideScores& scores = layer.sides[side];
        const std::string place =
            fmt::format("{} of '{}'{}", name_of(limit_.metric), layer.title,
                        layer.sides.size() > 1 ? (side == 0 ? " of A" : " of B") : "");
        const auto& value = value_of(scores, limit_.metric);
        if (value) {
            measured_ = true;
            if (exceeds(limit_, value->mean))
                lines_.push_back(fmt::format("{} is {:.6g}, {} {:.6g} is allowed", place,
                                             value->mean, limit_.above ? "at most" : "at least",
                                             limit_.value));
        }
        const auto& bad = value_of(scores, Metric::non_finite);
        if (!needs_finite(limit_.metric) || !bad || bad->mean == 0) return;
        if (!value && belongs(limit_.metric, layer.content)) {
            measured_ = true;
            lines_.push_back(place + " cannot be measured: no pixel is finite in both");
        } else if (value && !ignore_) {
            lines_.push_back(fmt::format(
                "{} leaves out {:.6g} pixels that are not finite (--ignore-non-finite allows it)",
                place, bad->mean));
        }
    }

    const Comparison& comparison_;
    const Limit& limit_;
    bool ignore_, measured_ = false;
    std::vector<std::string> lines_;
};

}  // namespace

Limit parse_limit(const std::string& text, bool above) {
    Limit limit;
    limit.above = above;
    limit.text = std::string(above ? "--fail-above " : "--fail-below ") + text;
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos)
        usage(limit.text, "must be METRIC=VALUE or LAYER:METRIC=VALUE, for example relmse=0.01");
    const std::string left = text.substr(0, equals);
    const std::size_t colon = left.rfind(':');
    if (colon != std::string::npos) limit.layer = left.substr(0, colon);
    const std::string name = colon == std::string::npos ? left : left.substr(colon + 1);
    const std::optional<Metric> metric = metric_named(name);
    if (!metric) {
        std::string all;
        for (const std::string& n : metric_names()) all += (all.empty() ? "" : ", ") + n;
        usage(limit.text, "unknown metric '" + name + "'" + did_you_mean(name, metric_names()) +
                              "; there are " + all);
    }
    limit.metric = *metric;
    if (less_is_closer(limit.metric) != above)
        usage(limit.text, above ? name + " is better the greater it is; give --fail-below"
                                : name + " is better the less it is; give --fail-above");
    limit.value = parse_value(text.substr(equals + 1), limit.text);
    return limit;
}

std::vector<std::string> exceeded(const Comparison& comparison, const std::vector<Limit>& limits,
                                  bool ignore_non_finite) {
    std::vector<std::string> lines;
    for (const Limit& limit : limits)
        for (std::string& line : LimitCheck(comparison, limit, ignore_non_finite).run())
            lines.push_back(std::move(line));
    if (!limits.empty())
        for (const LonePart& part : comparison.lone)
            lines.push_back("'" + part.name + "' is only in " + part.file +
                            " (--layer chooses what is compared)");
    return lines;
}

}  // namespace tessera
