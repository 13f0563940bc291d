#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/converge/report.h"

namespace tessera {
namespace {

using nlohmann::ordered_json;

// null for what is unknown: JSON has no other word for it.
ordered_json number(double v) { return std::isfinite(v) ? ordered_json(v) : ordered_json(nullptr); }

ordered_json interval(const std::optional<Interval>& i) {
    if (!i) return nullptr;
    return {{"value", number(i->value)},
            {"low", number(i->low)},
            {"high", number(i->high)},
            {"reliable", i->reliable}};
}

ordered_json ranged(const Ranged& r) {
    if (!r.known) return nullptr;
    return {{"value", number(r.value)},
            {"low", r.bounded ? number(r.low) : ordered_json(nullptr)},
            {"high", r.bounded ? number(r.high) : ordered_json(nullptr)}};
}

ordered_json truth(const std::optional<TrueError>& e) {
    if (!e) return nullptr;
    return {{"rmse", number(e->rmse)}, {"relmse", number(e->relmse)}, {"flip", number(e->flip)}};
}

ordered_json text_or_null(const std::string& s) {
    return s.empty() ? ordered_json(nullptr) : ordered_json(s);
}

ordered_json point(const ConvergePoint& p) {
    ordered_json estimate = nullptr;
    if (p.rmse || p.relmse) estimate = {{"rmse", interval(p.rmse)}, {"relmse", interval(p.relmse)}};
    return {{"spp", p.spp},
            {"wall", number(p.wall_s)},
            {"cpu", p.cpu_s ? number(*p.cpu_s) : ordered_json(nullptr)},
            {"rays", p.rays},
            {"memory_bytes", p.memory_peak},
            {"estimate", estimate},
            {"error", truth(p.truth)}};
}

ordered_json causes(const std::vector<ErrorCause>& list) {
    ordered_json out = ordered_json::array();
    for (const ErrorCause& c : list)
        out.push_back({{"paths", c.paths},
                       {"light", c.light},
                       {"seen", c.seen},
                       {"through", c.through},
                       {"share", number(c.share)},
                       {"remedy", c.remedy}});
    return out;
}

ordered_json run(const ConvergeRun& r) {
    ordered_json settings = ordered_json::object();
    for (const auto& [key, value] : r.settings) settings[key] = value;
    ordered_json curve = ordered_json::array();
    for (const ConvergePoint& p : r.curve) curve.push_back(point(p));
    return {{"series", r.series},
            {"build", text_or_null(r.build)},
            {"version", r.version},
            {"scene", r.scene},
            {"settings", settings},
            {"seed", r.seed},
            {"integrator", r.integrator},
            {"kernel", r.kernel},
            {"embree_isa", r.isa},
            {"threads", r.threads},
            {"complete", r.complete},
            {"failure", text_or_null(r.failure)},
            {"cautions", r.cautions},
            {"causes", causes(r.causes)},
            {"picture", text_or_null(r.file)},
            {"curve", curve}};
}

ordered_json series(const SeriesSummary& s) {
    ordered_json error = ordered_json::object(), estimate = ordered_json::object();
    for (const ErrorKind kind : kErrorKinds) {
        error[key_of(kind)] = ranged(s.truth[static_cast<int>(kind)]);
        if (kind != ErrorKind::flip)
            estimate[key_of(kind)] = ranged(s.estimate[static_cast<int>(kind)]);
    }
    estimate["reliable"] = s.reliable;
    return {{"label", s.label},
            {"runs", s.runs},
            {"spp", number(s.spp)},
            {"wall", number(s.wall_s)},
            {"cpu", s.cpu_s ? number(*s.cpu_s) : ordered_json(nullptr)},
            {"error", error},
            {"estimate", estimate},
            {"slope", {{"wall", ranged(s.wall_slope)}, {"spp", ranged(s.spp_slope)}}},
            {"efficiency", ranged(s.efficiency)},
            {"rays_per_second", number(s.rays_per_s)},
            {"memory_bytes", number(s.memory_peak)}};
}

ordered_json reference(const std::optional<ConvergeReference>& r) {
    if (!r) return nullptr;
    const bool rendered = !r->scene.empty();
    return {{"file", r->file},
            {"scene", text_or_null(r->scene)},
            {"spp", rendered ? ordered_json(r->spp) : ordered_json(nullptr)},
            {"seed", rendered ? ordered_json(r->seed) : ordered_json(nullptr)},
            {"relmse", interval(r->relmse)}};
}

ordered_json scene(const ConvergeScene& s) {
    ordered_json runs = ordered_json::array(), all = ordered_json::array();
    ordered_json pictures = ordered_json::array(), history = ordered_json::array();
    for (const ConvergeRun& r : s.runs) runs.push_back(run(r));
    for (const SeriesSummary& summary : summarise(s)) all.push_back(series(summary));
    for (const ForeignPicture& p : s.pictures)
        pictures.push_back(
            {{"label", p.label}, {"file", p.file}, {"wall", p.wall_s}, {"error", truth(p.truth)}});
    for (const HistoryRow& h : s.history)
        history.push_back({{"label", h.label}, {"wall", h.wall_s}});
    return {{"name", s.name},
            {"resolution", {s.width, s.height}},
            {"reference", reference(s.reference)},
            {"runs", runs},
            {"series", all},
            {"pictures", pictures},
            {"history", history},
            {"notes", s.notes}};
}

}  // namespace

std::string report_json(const ConvergeReport& report) {
    ordered_json scenes = ordered_json::array();
    for (const ConvergeScene& s : report.scenes) scenes.push_back(scene(s));
    const ordered_json j = {
        {"format", 1},
        {"version", report.version},
        {"complete", report.complete},
        {"command", report.command},
        {"date", report.date},
        {"machine",
         {{"host", report.host},
          {"cpu", report.cpu},
          {"system", report.system},
          {"threads", report.threads}}},
        {"limits",
         {{"spp", report.spp > 0 ? ordered_json(report.spp) : ordered_json(nullptr)},
          {"time", report.time_s > 0 ? ordered_json(report.time_s) : ordered_json(nullptr)},
          {"seeds", report.seeds}}},
        {"scenes", scenes},
        {"failures", report.failures}};
    // Names of files may be no UTF-8.
    return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace tessera
