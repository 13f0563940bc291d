#pragma once
// Pieces of the report's page.

#include <string>
#include <vector>

#include "renderer/converge/summary.h"

namespace tessera {

/// A square in a series' colour.
std::string swatch(std::size_t colour);

/// The numbers of a scene at the end of its runs; "" if there are none.
/// Of the first run of each series; empty if nothing is known.
std::string causes_table(const ConvergeScene& scene, const std::vector<SeriesSummary>& series);
std::string results_table(const ConvergeScene& scene, const std::vector<SeriesSummary>& series);

}  // namespace tessera
