#include <fmt/format.h>

#include <algorithm>

#include "renderer/compare/heat_map.h"
#include "renderer/converge/page.h"
#include "renderer/converge/report.h"
#include "renderer/converge/text.h"

namespace tessera {
namespace {

constexpr int kEnlarged = 480;  // pixels of width, below which the page shows them as squares

std::string swatch(std::size_t colour) {
    return fmt::format("<span class=\"swatch c{}\"></span>", colour % kPlotColours);
}

std::string small(const std::string& text) {
    return text.empty() ? "" : "<small>" + escaped(text) + "</small>";
}

std::string bounds(const Ranged& r) {
    return r.bounded ? three_figures(r.low) + " to " + three_figures(r.high) : "";
}

std::string cell(const Ranged& r, const char* key, const std::string& more = "") {
    return fmt::format("<td data-key=\"{}\" data-value=\"{}\">{}{}{}</td>", key,
                       r.known ? fmt::format("{}", r.value) : "",
                       r.known ? three_figures(r.value) : "–", small(bounds(r)), more);
}

std::string source_of(const std::string& bytes) {
    const bool png = bytes.starts_with("\x89PNG");
    return fmt::format("data:image/{};base64,{}", png ? "png" : "jpeg", base64(bytes));
}

// What the slider and the sheet show: pictures in the order of the table.
struct Shown {
    std::string id, label, full;
    const ShownPicture* picture;
};

std::vector<Shown> shown_of(const ConvergeScene& scene, const std::vector<SeriesSummary>& series,
                            std::size_t number) {
    std::vector<Shown> out;
    const auto add = [&](const std::string& label, const ShownPicture& p) {
        if (p.picture.empty()) return;
        std::string full = label;
        if (p.wall_s > 0) full += " · " + duration(p.wall_s);
        if (p.spp > 0) full += fmt::format(" · {} spp", p.spp);
        out.push_back({fmt::format("p{}-{}", number, out.size()), label, full, &p});
    };
    for (const SeriesSummary& s : series) add(s.label, scene.runs[s.runs[0]].shown);
    for (const ForeignPicture& p : scene.pictures) add(p.label, p.shown);
    if (scene.reference) add("reference", scene.reference->shown);
    return out;
}

std::string options(const std::vector<Shown>& shown, std::size_t chosen) {
    std::string out;
    for (std::size_t i = 0; i < shown.size(); ++i)
        out += fmt::format("<option value=\"{}\" data-full=\"{}\"{}>{}</option>", shown[i].id,
                           escaped(shown[i].full), i == chosen ? " selected" : "",
                           escaped(shown[i].label));
    return out;
}

std::string slider(const ConvergeScene& scene, const std::vector<Shown>& shown) {
    if (shown.empty()) return "";
    const bool maps = std::any_of(shown.begin(), shown.end(),
                                  [](const Shown& s) { return !s.picture->relative.empty(); });
    return fmt::format(
        R"(<h3>Pictures at equal time</h3>
<figure class="slider"><div class="picks">
<label>left <select class="run" aria-label="left picture">{0}</select></label>
<label>right <select class="run" aria-label="right picture">{1}</select></label>
<label>show <select class="what" aria-label="what is shown"><option value="picture">picture</option>{5}</select></label>
</div><div class="stage{4}" style="aspect-ratio:{2}/{3};max-width:calc(84vh * {2} / {3})"><img class="on-right" alt=""><img class="on-left" alt="">
<div class="handle"></div><span class="name left"></span><span class="name right"></span></div>
<input type="range" min="0" max="100" step="0.1" value="50" aria-label="edge between left and right picture">
</figure>
)",
        options(shown, 0), options(shown, std::min<std::size_t>(1, shown.size() - 1)), scene.width,
        scene.height, scene.width < kEnlarged ? " enlarged" : "",
        maps ? "<option value=\"relative\">relative error</option><option "
               "value=\"flip\">FLIP</option>"
             : "");
}

// The colours of the heat maps, as a strip.
std::string map_scale() {
    std::string stops;
    for (int i = 0; i <= 16; ++i) {
        const auto c = cubehelix(static_cast<float>(i) / 16);
        stops += fmt::format(",rgb({:.0f} {:.0f} {:.0f})", c[0] * 255, c[1] * 255, c[2] * 255);
    }
    return fmt::format(
        "<div class=\"scale\" style=\"background:linear-gradient(to right{})\"></div>"
        "<div class=\"ends\"><span>0.1 %</span><span>relative error</span><span>1000 %</span></div>"
        "<div class=\"ends\"><span>0</span><span>FLIP</span><span>1</span></div>",
        stops);
}

std::string image(const Shown& s, const char* what, const std::string& bytes) {
    if (bytes.empty()) return "";
    return fmt::format("<img id=\"{0}-{1}\" src=\"{2}\" alt=\"{1} of {3}\">", s.id, what,
                       source_of(bytes), escaped(s.label));
}

std::string sheet(const std::vector<Shown>& shown) {
    if (shown.empty()) return "";
    std::string out = "<h3>Picture, relative error, FLIP</h3>\n<div class=\"sheet\">";
    bool maps = false;
    for (const Shown& s : shown) {
        maps = maps || !s.picture->relative.empty();
        out += fmt::format(
            "<figure><div class=\"three\">{}{}{}</div><figcaption>{}</figcaption></figure>\n",
            image(s, "picture", s.picture->picture), image(s, "relative", s.picture->relative),
            image(s, "flip", s.picture->flip), escaped(s.full));
    }
    return out + "</div>" + (maps ? "<p></p>" + map_scale() : "") + "\n";
}

std::string plots(const ConvergeScene& scene, const std::vector<SeriesSummary>& series) {
    std::string buttons, figures;
    for (const ErrorKind kind : kErrorKinds) {
        std::string drawn;
        for (const PlotAxis axis : kPlotAxes) {
            const Plot plot = make_plot(scene, series, kind, axis);
            if (!plot.series.empty()) drawn += draw_plot(plot, PlotUse::page);
        }
        if (drawn.empty()) continue;
        const bool first = figures.empty();
        buttons +=
            fmt::format("<button type=\"button\" data-kind=\"{}\" aria-pressed=\"{}\">{}</button>",
                        key_of(kind), first, title_of(kind));
        figures += fmt::format("<div class=\"plots\" data-kind=\"{}\"{}>{}</div>\n", key_of(kind),
                               first ? "" : " hidden", drawn);
    }
    if (figures.empty()) return "";
    std::string legend;
    std::size_t colour = 0;
    const auto add = [&](const std::string& label) {
        legend += fmt::format("<li>{}<span>{}</span></li>", swatch(colour++), escaped(label));
    };
    for (const SeriesSummary& s : series) add(s.label);
    for (const ForeignPicture& p : scene.pictures)
        if (p.truth) add(p.label);
    const char* const what =
        scene.reference
            ? "Lines: the error against the reference. Bands: what the render said of itself, "
              "without knowing it, at 95 %; pale where it called that unreliable."
            : "Lines and bands: the render's own estimate with its 95 % interval; pale where it "
              "called that unreliable.";
    return fmt::format(
        "<h3>Error against time and samples</h3>\n<div class=\"choice\">{}</div>\n{}<ul "
        "class=\"legend\">{}</ul><p class=\"soft\">{} Dotted: the slope of independent "
        "samples.</p>\n",
        buttons, figures, legend, what);
}

std::string estimate_cell(const SeriesSummary& s) {
    return cell(s.estimate[0], "estimate",
                s.estimate[0].known && !s.reliable ? "<small>unreliable</small>" : "");
}

std::string row(const ConvergeScene& scene, const SeriesSummary& s, std::size_t colour,
                const SeriesSummary& first) {
    const Ranged& e = s.efficiency;
    const bool same_kind = e.known && first.efficiency.known && s.comparable == first.comparable;
    std::string ratio;
    if (same_kind && colour > 0) ratio = three_figures(e.value / first.efficiency.value) + "×";
    const ConvergeRun& run = scene.runs[s.runs[0]];
    std::string what = fmt::format("{}, {}", run.integrator, run.kernel);
    if (!run.build.empty()) what += ", " + run.version;
    return fmt::format(
        "<tr data-series=\"{}\"><td>{}{}{}</td><td data-key=\"wall\" "
        "data-value=\"{}\">{}{}</td><td>{:.6g}</td>{}{}{}{}{}{}{}"
        "<td>{}</td><td>{} MiB</td></tr>\n",
        escaped(s.label), swatch(colour), escaped(s.label), small(what), s.wall_s,
        duration(s.wall_s), s.cpu_s ? small("CPU " + duration(*s.cpu_s)) : "", s.spp,
        cell(s.truth[0], "relmse"), cell(s.truth[1], "rmse"), cell(s.truth[2], "flip"),
        estimate_cell(s), cell(s.wall_slope, "slope_wall"), cell(s.spp_slope, "slope_spp"),
        cell(e, "efficiency", small(ratio)), with_prefix(s.rays_per_s),
        three_figures(s.memory_peak / (1 << 20)));
}

Ranged exactly(double v) { return {v, v, v, true, false}; }

std::string table(const ConvergeScene& scene, const std::vector<SeriesSummary>& series) {
    if (series.empty() && scene.pictures.empty() && scene.history.empty()) return "";
    std::string rows;
    for (const HistoryRow& h : scene.history) {
        std::string ratio;
        if (!series.empty() && series[0].wall_s > 0)
            ratio = small(three_figures(h.wall_s / series[0].wall_s) + "× " + series[0].label);
        rows += fmt::format("<tr class=\"history\"><td>{}</td><td>{}{}</td>{}</tr>\n",
                            escaped(h.label), duration(h.wall_s), ratio,
                            "<td>–</td><td>–</td><td>–</td><td>–</td><td>–</td><td>–</td><td>–</td>"
                            "<td>–</td><td>–</td><td>–</td>");
    }
    std::size_t colour = 0;
    for (const SeriesSummary& s : series) {
        rows += row(scene, s, colour, series[0]);
        ++colour;
    }
    for (const ForeignPicture& p : scene.pictures) {
        const TrueError e = p.truth.value_or(TrueError{});
        rows += fmt::format(
            "<tr><td>{}{}{}</td><td>{}</td><td>–</td>{}{}{}<td>–</td><td>–</td><td>–</td>{}<td>–</"
            "td><td>–</td></tr>\n",
            p.truth ? swatch(colour) : "", escaped(p.label), small(p.file), duration(p.wall_s),
            cell(p.truth ? exactly(e.relmse) : Ranged{}, "relmse"),
            cell(p.truth ? exactly(e.rmse) : Ranged{}, "rmse"),
            cell(p.truth ? exactly(e.flip) : Ranged{}, "flip"),
            cell(p.truth ? exactly(1 / (e.relmse * p.wall_s)) : Ranged{}, "efficiency"));
        colour += p.truth ? 1 : 0;
    }
    return "<h3>At the end</h3>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
           "aria-label=\"numbers at the end\"><table><thead><tr><th>run</th>"
           "<th>seconds</th><th>spp</th><th>relMSE</th><th>RMSE</th><th>FLIP</th>"
           "<th>own estimate<br>of relMSE</th><th>slope<br>by time</th><th>slope<br>by samples</th>"
           "<th>efficiency<br>1/(relMSE·s)</th><th>rays/s</th><th>memory</th></tr></"
           "thead><tbody>\n" +
           rows + "</tbody></table></div>\n";
}

std::string reference_text(const ConvergeScene& s) {
    if (!s.reference) return "no reference: errors are the renders' own estimates";
    const ConvergeReference& r = *s.reference;
    if (r.scene.empty()) return "reference " + r.file;
    std::string out =
        fmt::format("reference {} of {}, {} spp, seed {}", r.file, r.scene, r.spp, r.seed);
    if (r.relmse) out += ", its own relMSE " + three_figures(r.relmse->value);
    return out;
}

std::string section(const ConvergeScene& scene, std::size_t number) {
    const std::vector<SeriesSummary> series = summarise(scene);
    const std::vector<Shown> shown = shown_of(scene, series, number);
    std::string out = fmt::format("<section id=\"s{}\" data-scene=\"{}\"><h2>{}</h2>\n", number,
                                  escaped(scene.name), escaped(scene.name));
    out += fmt::format("<p class=\"soft\">{} × {}, {}</p>\n", scene.width, scene.height,
                       escaped(reference_text(scene)));
    for (const ConvergeRun& r : scene.runs)
        if (!r.failure.empty())
            out += fmt::format("<p class=\"failed\">{}, seed {}: {}</p>\n", escaped(r.series),
                               r.seed, escaped(r.failure));
    for (const std::string& note : scene.notes)
        out += "<p class=\"soft\">" + escaped(note) + "</p>\n";
    return out + table(scene, series) + plots(scene, series) + slider(scene, shown) + sheet(shown) +
           "</section>\n";
}

std::string provenance(const ConvergeReport& r) {
    std::string limits;
    if (r.time_s > 0) limits += duration(r.time_s);
    if (r.spp > 0) limits += fmt::format("{}{} spp", limits.empty() ? "" : " or ", r.spp);
    limits += fmt::format(", {} seed{}", r.seeds, r.seeds == 1 ? "" : "s");
    std::string out = "<dl>";
    const auto add = [&](const char* name, const std::string& value) {
        out += fmt::format("<dt>{}</dt><dd>{}</dd>", name, value);
    };
    add("version", "Tessera " + escaped(r.version));
    add("command", "<code>" + escaped(r.command) + "</code>");
    add("machine",
        escaped(fmt::format("{} ({}), {}, {} threads", r.host, r.cpu, r.system, r.threads)));
    add("date", escaped(r.date));
    add("limits", escaped(limits));
    return out + "</dl>";
}

constexpr const char* kMethod =
    "<p>Seconds are of rendering alone: loading, comparing and writing are left out. An interval "
    "in "
    "small figures is at 95 %: Student's over the seeds where there are several, else the one that "
    "the render states of its estimate. Slopes are least squares through the logarithms of all "
    "points of a curve; of one seed the interval is that of the fit, whose points share their "
    "samples, and so is too narrow; of several it is Student's of their slopes. Independent "
    "samples "
    "have the slope −1. Efficiency is 1/(relMSE × s) at the end.</p>";

}  // namespace

std::string report_html(const ConvergeReport& report) {
    std::string out = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta "
        "name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta "
        "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
        "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<link rel=\"icon\" "
        "href=\"data:,\">\n<title>Error against run time</title>\n<style>\n{}</style></head>\n"
        "<body><header><h1>Error against run time</h1><p class=\"soft\">{} · {} · {} "
        "threads</p></header>\n<main>\n",
        page_style(), escaped("Tessera " + report.version), escaped(report.date), report.threads);
    if (!report.complete)
        out += "<p class=\"failed\">Stopped by a signal: the report holds what there was.</p>\n";
    for (const std::string& f : report.failures)
        out += "<p class=\"failed\">" + escaped(f) + "</p>\n";
    for (std::size_t i = 0; i < report.scenes.size(); ++i) out += section(report.scenes[i], i);
    out += "</main>\n<footer>" + std::string(kMethod) + provenance(report) + "</footer>\n";
    out += "<script type=\"application/json\" id=\"report\">" + inside_script(report_json(report)) +
           "</script>\n<script>" + std::string(page_script()) + "</script>\n</body></html>\n";
    return out;
}

}  // namespace tessera
