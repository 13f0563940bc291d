#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/cli/compare_report.h"

namespace tessera {
namespace {

using nlohmann::ordered_json;

// JSON has no infinity: null, which only PSNR of equal pictures and relative errors over black are.
ordered_json number(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(nullptr); }

const char* name_of(LayerContent content) {
    switch (content) {
        case LayerContent::colour:
            return "colour";
        case LayerContent::data:
            return "data";
        case LayerContent::ids:
            break;
    }
    return "ids";
}

ordered_json counts(const ValueCounts& n) {
    return {{"nan", n.nan}, {"infinite", n.infinite}, {"negative", n.negative}};
}

ordered_json metrics_of(const SideScores& side) {
    ordered_json out = ordered_json::object();
    for (std::size_t m = 0; m < kMetrics; ++m) {
        const auto& v = side.values[m];
        if (!v) continue;
        ordered_json j{{"value", number(v->mean)}};
        if (v->count > 1) j["low"] = number(v->low), j["high"] = number(v->high);
        out[std::string(name_of(static_cast<Metric>(m)))] = j;
    }
    return out;
}

ordered_json channels_of(const SideScores& side) {
    ordered_json out = ordered_json::array();
    for (const ChannelScores& c : side.channels) {
        ordered_json j{{"name", c.name}};
        if (c.mean_ratio) j["mean_ratio"] = number(*c.mean_ratio);
        j["values"] = counts(c.a), j["reference_values"] = counts(c.reference);
        out.push_back(j);
    }
    return out;
}

ordered_json verdicts_of(const ComparedLayer& layer) {
    ordered_json out = ordered_json::object();
    for (std::size_t m = 0; m < kMetrics; ++m) {
        const auto &a = layer.sides[0].values[m], &b = layer.sides[1].values[m];
        if (!a || !b || a->count < 2 || b->count < 2) continue;
        const auto metric = static_cast<Metric>(m);
        const Closer who = closer(*a, *b, less_is_closer(metric));
        out[std::string(name_of(metric))] = who == Closer::unknown ? "none"
                                            : who == Closer::a     ? "a"
                                                                   : "b";
    }
    return out;
}

ordered_json layer_of(const ComparedLayer& layer) {
    ordered_json j{
        {"name", layer.title}, {"content", name_of(layer.content)}, {"pixels", layer.pixels}};
    if (layer.epsilon) j["relmse_epsilon"] = number(*layer.epsilon);
    if (layer.psnr_peak) j["psnr_peak"] = number(*layer.psnr_peak);
    for (std::size_t s = 0; s < layer.sides.size(); ++s)
        j[s == 0 ? "a" : "b"] = {{"metrics", metrics_of(layer.sides[s])},
                                 {"channels", channels_of(layer.sides[s])}};
    if (layer.sides.size() > 1) j["verdicts"] = verdicts_of(layer);
    return j;
}

}  // namespace

std::string as_json(const Comparison& c, const std::vector<Limit>& limits,
                    const std::vector<std::string>& failures) {
    ordered_json j{{"format", 1}, {"a", c.sides[0]}};
    if (c.sides.size() > 1) j["b"] = c.sides[1];
    j["reference"] = c.reference;
    j["width"] = c.width, j["height"] = c.height;
    j["values"] = c.encoded ? "srgb" : "linear";
    if (!c.encoded) j["primaries"] = c.working_space;
    j["layers"] = ordered_json::array();
    for (const ComparedLayer& layer : c.layers) j["layers"].push_back(layer_of(layer));
    j["only_in"] = ordered_json::array();
    for (const LonePart& part : c.lone)
        j["only_in"].push_back({{"name", part.name}, {"file", part.file}});
    j["notes"] = c.notes;
    j["limits"] = ordered_json::array();
    for (const Limit& l : limits) j["limits"].push_back(l.text);
    j["exceeded"] = failures;
    j["passed"] = failures.empty();
    // What a file says of itself may be no UTF-8.
    return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace tessera
