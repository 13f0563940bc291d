#include <fmt/format.h>

#include <cmath>

#include "renderer/converge/html_parts.h"
#include "renderer/converge/plot.h"
#include "renderer/converge/text.h"

namespace tessera {
namespace {

constexpr double kMiB = 1 << 20;

std::string small(const std::string& text) {
    return text.empty() ? "" : "<small>" + escaped(text) + "</small>";
}

std::string cell(const std::string& content) { return "<td>" + content + "</td>"; }

std::string nothing() { return cell("–"); }

// What a number is called in report.json stands beside it.
std::string cell(const Ranged& r, const char* key, const std::string& more = "") {
    if (!r.known) return nothing();
    const std::string bounds =
        r.bounded ? three_figures(r.low) + " to " + three_figures(r.high) : "";
    return fmt::format("<td data-key=\"{}\" data-value=\"{}\">{}{}{}</td>", key, r.value,
                       three_figures(r.value), small(bounds), small(more));
}

// To three figures: "9650", "0.154".
std::string rounded(double v) {
    if (!(v >= 1000 && v < 1e9)) return fmt::format("{:.3g}", v);
    const double unit = std::pow(10.0, std::floor(std::log10(v)) - 2);
    return fmt::format("{:.0f}", std::round(v / unit) * unit);
}

Ranged exactly(double v) { return {v, v, v, true, false}; }

// True errors are left out where nothing is known of them.
class ResultsTable {
public:
    ResultsTable(const ConvergeScene& scene, const std::vector<SeriesSummary>& series)
        : scene_(scene), series_(series), truth_(scene.reference.has_value()) {}

    std::string run() {
        for (const HistoryRow& h : scene_.history) add(h);
        for (const SeriesSummary& s : series_) add(s);
        for (const ForeignPicture& p : scene_.pictures) add(p);
        if (rows_.empty()) return "";
        return "<h3>At the end</h3>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
               "aria-label=\"numbers at the end\"><table><thead><tr><th>run</th><th>seconds</th>"
               "<th>spp</th>" +
               std::string(truth_ ? "<th>relMSE</th><th>RMSE</th><th>FLIP</th>" : "") +
               "<th>own estimate<br>of relMSE</th><th>slope<br>by time</th><th>slope<br>by "
               "samples</th><th>efficiency<br>1/(relMSE·s)</th><th>rays/s,<br>memory</th></tr>"
               "</thead><tbody>\n" +
               rows_ + "</tbody></table></div>\n";
    }

private:
    void add(const HistoryRow& h) {
        std::string ratio;
        if (!series_.empty()) {
            const ConvergePoint& p = scene_.runs[series_[0].runs[0]].curve.front();
            ratio = fmt::format("{} times {} spp of {}", rounded(h.wall_s / p.wall_s), p.spp,
                                series_[0].label);
        }
        rows_ += "<tr>" + cell(escaped(h.label)) + cell(duration(h.wall_s) + small(ratio));
        for (int i = 0; i < 6 + (truth_ ? 3 : 0); ++i) rows_ += nothing();
        rows_ += "</tr>\n";
    }

    void add(const SeriesSummary& s) {
        const SeriesSummary& first = series_[0];
        const ConvergeRun& run = scene_.runs[s.runs[0]];
        std::string what = run.integrator + ", " + run.kernel;
        if (!run.build.empty()) what += ", " + run.version;
        const bool comparable = s.efficiency.known && first.efficiency.known &&
                                s.comparable == first.comparable && &s != &first;
        const std::string ratio =
            comparable
                ? fmt::format("{} times {}", rounded(s.efficiency.value / first.efficiency.value),
                              first.label)
                : "";
        rows_ += fmt::format(
            "<tr data-series=\"{0}\">{1}<td data-key=\"wall\" "
            "data-value=\"{2}\">{3}{4}</td>{5}",
            escaped(s.label), cell(swatch(colour_++) + escaped(s.label) + small(what)), s.wall_s,
            duration(s.wall_s), s.cpu_s ? small("CPU " + duration(*s.cpu_s)) : "",
            cell(fmt::format("{:.0f}", s.spp)));
        for (const ErrorKind kind : kErrorKinds)
            if (truth_) rows_ += cell(s.truth[static_cast<int>(kind)], key_of(kind));
        rows_ += cell(s.estimate[0], "estimate", s.reliable ? "" : "unreliable") +
                 cell(s.wall_slope, "slope_wall") + cell(s.spp_slope, "slope_spp") +
                 cell(s.efficiency, "efficiency", ratio) +
                 cell(with_prefix(s.rays_per_s) +
                      small(fmt::format("{:.0f} MiB", s.memory_peak / kMiB))) +
                 "</tr>\n";
    }

    void add(const ForeignPicture& p) {
        const TrueError e = p.truth.value_or(TrueError{});
        rows_ += "<tr>" +
                 cell((p.truth ? swatch(colour_++) : "") + escaped(p.label) + small(p.file)) +
                 cell(duration(p.wall_s)) + nothing();
        if (truth_)
            rows_ += cell(exactly(e.relmse), "relmse") + cell(exactly(e.rmse), "rmse") +
                     cell(exactly(e.flip), "flip");
        const double product = e.relmse * p.wall_s;
        rows_ += nothing() + nothing() + nothing() +
                 cell(product > 0 ? exactly(1 / product) : Ranged{}, "efficiency") + nothing() +
                 "</tr>\n";
    }

    const ConvergeScene& scene_;
    const std::vector<SeriesSummary>& series_;
    bool truth_;
    std::size_t colour_ = 0;
    std::string rows_;
};

}  // namespace

std::string swatch(std::size_t colour) {
    return fmt::format("<span class=\"swatch c{}\"></span>", colour % kPlotColours);
}

std::string results_table(const ConvergeScene& scene, const std::vector<SeriesSummary>& series) {
    return ResultsTable(scene, series).run();
}

}  // namespace tessera
