#pragma once
// What `tessera converge` has seen, as files: docs/converge.md.

#include <string>
#include <vector>

#include "renderer/converge/plot.h"
#include "renderer/converge/summary.h"

namespace tessera {

/// docs/converge.schema.json
std::string report_json(const ConvergeReport& report);

/// A line for each point of each curve; what is unknown is empty.
std::string report_csv(const ConvergeReport& report);

/// One file that needs no other.
std::string report_html(const ConvergeReport& report);

enum class PlotAxis : unsigned char { wall, spp };
inline constexpr PlotAxis kPlotAxes[] = {PlotAxis::wall, PlotAxis::spp};

/// Errors of a kind against wall seconds or samples. No series: nothing is known of it.
Plot make_plot(const ConvergeScene& scene, const std::vector<SeriesSummary>& series, ErrorKind kind,
               PlotAxis axis);

/// "12.3 (11.9 to 12.7)"; "-" for what is unknown.
std::string to_text(const Ranged& r);

}  // namespace tessera
