#pragma once
// A plot of errors on logarithmic axes, drawn as SVG.

#include <optional>
#include <string>
#include <vector>

namespace tessera {

/// Which the styles know; more series than these begin again.
inline constexpr int kPlotColours = 8;

struct PlotPoint {
    double x = 0, y = 0;
    double low = 0, high = 0;  // of a bar; none where they are y
    std::string tip;           // shown for it
};

struct PlotBand {
    double x = 0, low = 0, high = 0;
    bool reliable = false;
};

struct PlotSeries {
    std::string label;
    int colour = 0;
    std::vector<PlotPoint> points;
    std::vector<PlotBand> band;
    bool joined = true;  // by a line
};

struct Plot {
    std::string title, x_title, y_title;
    std::vector<PlotSeries> series;
    std::optional<double> floor;  // below which nothing can be told
    std::optional<double> guide;  // slope of a line to compare with
};

enum class PlotUse : unsigned char {
    file,  // a whole file with title, legend and styles
    page,  // within HTML that has them
};

/// What has no logarithm is left out.
std::string draw_plot(const Plot& plot, PlotUse use);

}  // namespace tessera
