#include <fmt/format.h>

#include <algorithm>

#include "renderer/compare/heat_map.h"
#include "renderer/converge/html_parts.h"
#include "renderer/converge/page.h"
#include "renderer/converge/report.h"
#include "renderer/converge/text.h"

namespace tessera {
namespace {

constexpr int kEnlarged = 480;  // pixels of width, below which the page shows them as squares

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
    if (shown.size() < 2) return "";
    const bool maps = std::any_of(shown.begin(), shown.end(),
                                  [](const Shown& s) { return !s.picture->relative.empty(); });
    return fmt::format(
        R"page(<h3>Pictures at equal time</h3>
<figure class="slider" style="max-width:max(300px, calc(72vh * {2} / {3}))"><div class="picks">
<label>left <select class="run" aria-label="left picture">{0}</select></label>
<label>right <select class="run" aria-label="right picture">{1}</select></label>
<label>show <select class="what" aria-label="what is shown"><option value="picture">picture</option>{5}</select></label>
</div><div class="stage{4}" style="aspect-ratio:{2}/{3}"><img class="on-right" alt=""><img class="on-left" alt="">
<div class="handle"></div><span class="name left"></span><span class="name right"></span></div>
<input type="range" min="0" max="100" step="0.1" value="50" aria-label="edge between left and right picture">
</figure>
)page",
        options(shown, 0), options(shown, 1), scene.width, scene.height,
        scene.width < kEnlarged ? " enlarged" : "",
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

std::string reference_text(const ConvergeScene& s) {
    if (!s.reference) return "no reference: errors are the renders' own estimates";
    const ConvergeReference& r = *s.reference;
    if (r.scene.empty()) return "reference " + r.file;
    std::string out = fmt::format("reference of {}, {} spp, seed {}", r.scene, r.spp, r.seed);
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
    return out + results_table(scene, series) + plots(scene, series) + causes_table(scene, series) +
           slider(scene, shown) + sheet(shown) + "</section>\n";
}

std::string contents(const ConvergeReport& report) {
    std::string out = "<nav aria-label=\"scenes\">";
    for (std::size_t i = 0; i < report.scenes.size(); ++i)
        out += fmt::format("<a href=\"#s{}\">{}</a> ", i, escaped(report.scenes[i].name));
    return out + "</nav>\n";
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
    if (report.scenes.size() > 1) out += contents(report);
    for (std::size_t i = 0; i < report.scenes.size(); ++i) out += section(report.scenes[i], i);
    out += "</main>\n<footer>" + std::string(kMethod) + provenance(report) + "</footer>\n";
    out += "<script type=\"application/json\" id=\"report\">" + inside_script(report_json(report)) +
           "</script>\n<script>" + std::string(page_script()) + "</script>\n</body></html>\n";
    return out;
}

}  // namespace tessera
