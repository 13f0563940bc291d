#include <fmt/format.h>

#include "renderer/converge/report.h"
#include "renderer/converge/text.h"

namespace tessera {
namespace {

std::string samples_text(double spp) { return fmt::format("{:.6g} spp", spp); }

std::string tip(const SeriesSummary& s, const MeanPoint& p, const std::optional<Interval>& own,
                ErrorKind kind) {
    std::string out = fmt::format("{}\n{} {}\n{}, {}", s.label, title_of(kind), to_text(p.error),
                                  duration(p.wall_s), samples_text(p.spp));
    if (s.comparable && own)
        out += fmt::format("\nsays of itself {} ({} to {}){}", three_figures(own->value),
                           three_figures(own->low), three_figures(own->high),
                           own->reliable ? "" : ", unreliable");
    return out;
}

const ConvergePoint* point_at(const ConvergeRun& run, double spp) {
    for (const ConvergePoint& p : run.curve)
        if (p.spp == spp) return &p;
    return nullptr;
}

PlotSeries plot_series(const ConvergeScene& scene, const SeriesSummary& s, ErrorKind kind,
                       PlotAxis axis) {
    PlotSeries out;
    out.label = s.label;
    std::vector<const ConvergeRun*> runs;
    for (const std::size_t i : s.runs) runs.push_back(&scene.runs[i]);
    for (const MeanPoint& p : mean_curve(runs, kind)) {
        const ConvergePoint* const of_first = point_at(*runs[0], p.spp);
        std::optional<Interval> own;
        if (of_first) own = estimate_at(*of_first, kind);
        const double x = axis == PlotAxis::wall ? p.wall_s : p.spp;
        out.points.push_back({x, p.error.value, p.error.low, p.error.high, tip(s, p, own, kind)});
    }
    for (const ConvergePoint& p : runs[0]->curve) {
        const std::optional<Interval> own = estimate_at(p, kind);
        if (!own) continue;
        const double x = axis == PlotAxis::wall ? p.wall_s : p.spp;
        out.band.push_back({x, own->low, own->high, own->reliable});
    }
    return out;
}

PlotSeries lone_point(const ForeignPicture& p, ErrorKind kind) {
    const double e = kind == ErrorKind::relmse ? p.truth->relmse
                     : kind == ErrorKind::rmse ? p.truth->rmse
                                               : p.truth->flip;
    PlotSeries out;
    out.label = p.label;
    out.joined = false;
    out.points.push_back({p.wall_s, e, e, e,
                          fmt::format("{}\n{} {}\n{}", p.label, title_of(kind), three_figures(e),
                                      duration(p.wall_s))});
    return out;
}

}  // namespace

std::string to_text(const Ranged& r) {
    if (!r.known) return "-";
    if (!r.bounded) return three_figures(r.value);
    return fmt::format("{} ({} to {})", three_figures(r.value), three_figures(r.low),
                       three_figures(r.high));
}

Plot make_plot(const ConvergeScene& scene, const std::vector<SeriesSummary>& series, ErrorKind kind,
               PlotAxis axis) {
    Plot plot;
    const bool wall = axis == PlotAxis::wall;
    plot.title =
        fmt::format("{}: {} against {}", scene.name, title_of(kind), wall ? "seconds" : "samples");
    plot.x_title = wall ? "seconds of rendering" : "samples per pixel";
    plot.y_title = title_of(kind);
    if (kind == ErrorKind::rmse) plot.y_title += " (radiance)";
    if (kind == ErrorKind::relmse && scene.reference && scene.reference->relmse)
        plot.floor = scene.reference->relmse->value;
    if (kind == ErrorKind::relmse) plot.guide = -1;
    if (kind == ErrorKind::rmse) plot.guide = -0.5;
    int colour = 0;
    const auto add = [&](PlotSeries s) {
        s.colour = colour++;
        if (!s.points.empty()) plot.series.push_back(std::move(s));
    };
    for (const SeriesSummary& s : series) add(plot_series(scene, s, kind, axis));
    for (const ForeignPicture& p : scene.pictures)
        if (p.truth && wall) add(lone_point(p, kind));
    return plot;
}

}  // namespace tessera
