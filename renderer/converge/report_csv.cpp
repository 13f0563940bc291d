#include <fmt/format.h>

#include <cmath>

#include "renderer/converge/report.h"
#include "renderer/converge/text.h"

namespace tessera {
namespace {

std::string number(double v) { return std::isfinite(v) ? fmt::format("{}", v) : ""; }

std::string interval(const std::optional<Interval>& i) {
    if (!i) return ",,";
    return number(i->value) + "," + number(i->low) + "," + number(i->high);
}

std::string line(const ConvergeScene& s, const ConvergeRun& r, const ConvergePoint& p) {
    const char* const reliable = !p.relmse ? "" : p.relmse->reliable ? "true" : "false";
    return fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_field(s.name), csv_field(r.series),
        csv_field(r.build), r.seed, p.spp, number(p.wall_s), p.cpu_s ? number(*p.cpu_s) : "",
        p.rays, p.memory_peak, interval(p.rmse), interval(p.relmse), reliable,
        p.truth
            ? number(p.truth->rmse) + "," + number(p.truth->relmse) + "," + number(p.truth->flip)
            : ",,");
}

}  // namespace

std::string report_csv(const ConvergeReport& report) {
    std::string out =
        "scene,series,build,seed,spp,wall,cpu,rays,memory_bytes,"
        "estimate_rmse,estimate_rmse_low,estimate_rmse_high,"
        "estimate_relmse,estimate_relmse_low,estimate_relmse_high,estimate_relmse_reliable,"
        "rmse,relmse,flip\n";
    for (const ConvergeScene& s : report.scenes)
        for (const ConvergeRun& r : s.runs)
            for (const ConvergePoint& p : r.curve) out += line(s, r, p);
    return out;
}

}  // namespace tessera
