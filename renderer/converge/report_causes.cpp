#include <fmt/format.h>

#include <cmath>

#include "renderer/converge/html_parts.h"
#include "renderer/converge/text.h"

namespace tessera {
namespace {

constexpr double kWorthARow = 0.01;

std::string name_cell(const std::string& name) {
    return "<td>" + (name.empty() ? "–" : escaped(name)) + "</td>";
}

std::string rows_of(const ConvergeRun& run, const std::string& label) {
    std::string out;
    for (const ErrorCause& c : run.causes) {
        if (!(std::abs(c.share) >= kWorthARow)) continue;
        out += fmt::format("<tr><td>{}</td><td>{:.0f} %</td><td>{}</td>{}{}{}</tr>\n",
                           out.empty() ? escaped(label) : "", 100 * c.share, escaped(c.paths),
                           name_cell(c.light), name_cell(c.through), name_cell(c.seen));
    }
    return out;
}

}  // namespace

std::string causes_table(const ConvergeScene& scene, const std::vector<SeriesSummary>& series) {
    std::string rows;
    for (const SeriesSummary& s : series) rows += rows_of(scene.runs[s.runs[0]], s.label);
    if (rows.empty()) return "";
    return "<h3>What makes the error</h3>\n<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
           "aria-label=\"causes of the error\"><table class=\"causes\"><thead><tr><th>run</th>"
           "<th>share</th><th>paths</th><th>light</th><th>by way of</th><th>seen on</th></tr>"
           "</thead><tbody>\n" +
           rows + "</tbody></table></div>\n";
}

}  // namespace tessera
