#include "renderer/converge/plot.h"

#include <fmt/format.h>

#include <cmath>

#include "renderer/converge/log_axis.h"
#include "renderer/converge/page.h"
#include "renderer/converge/text.h"

namespace tessera {
namespace {

constexpr double kWidth = 480, kHeight = 360;
constexpr double kLeft = 68, kRight = 14, kTop = 12, kBottom = 50;
constexpr double kTitle = 34, kLegendLine = 22;

bool has_logarithm(double v) { return std::isfinite(v) && v > 1e-300; }
bool drawn(const PlotBand& b) {
    return has_logarithm(b.x) && has_logarithm(b.low) && has_logarithm(b.high);
}
bool drawn(const PlotPoint& p) { return has_logarithm(p.x) && has_logarithm(p.y); }

const char* const kShapes[] = {"M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0Z", "M-3.6 -3.6H3.6V3.6H-3.6Z",
                               "M0 -5L4.6 3.4H-4.6Z", "M0 -5L5 0L0 5L-5 0Z"};

class Drawing {
public:
    Drawing(const Plot& plot, PlotUse use)
        : plot_(plot),
          use_(use),
          top_(kTop + (use == PlotUse::file ? kTitle : 0)),
          bottom_(top_ + kHeight - kTop - kBottom),
          x_(values(true), kLeft, kWidth - kRight),
          y_(values(false), bottom_, top_) {}

    std::string run() {
        const bool file = use_ == PlotUse::file;
        const double height =
            bottom_ + kBottom +
            (file ? 8 + kLegendLine * static_cast<double>(plot_.series.size()) : 0);
        out_ = fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 {0:g} "
            "{1:g}\"{2} "
            "role=\"img\" aria-label=\"{3}\">",
            kWidth, height,
            file ? fmt::format(" width=\"{:g}\" height=\"{:g}\"", kWidth, height) : "",
            escaped(plot_.title));
        if (file) {
            out_ += fmt::format(
                "<style>{}</style><rect class=\"paper\" width=\"{:g}\" height=\"{:g}\"/>",
                plot_style(), kWidth, height);
            text("title", kWidth / 2, 24, plot_.title);
        }
        grid();
        if (plot_.guide) guide(*plot_.guide);
        if (plot_.floor && has_logarithm(*plot_.floor)) floor(*plot_.floor);
        for (const PlotSeries& s : plot_.series) series(s);
        out_ += fmt::format(
            "<rect class=\"frame\" x=\"{:g}\" y=\"{:g}\" width=\"{:g}\" height=\"{:g}\"/>", kLeft,
            top_, kWidth - kRight - kLeft, bottom_ - top_);
        text("axis", (kLeft + kWidth - kRight) / 2, bottom_ + 42, plot_.x_title);
        out_ += fmt::format(
            "<text class=\"axis\" transform=\"translate(16 {:.1f}) rotate(-90)\">{}</text>",
            (top_ + bottom_) / 2, escaped(plot_.y_title));
        if (file) legend();
        return out_ + "</svg>\n";
    }

private:
    std::vector<double> values(bool x) const {
        std::vector<double> out;
        for (const PlotSeries& s : plot_.series) {
            for (const PlotPoint& p : s.points)
                if (drawn(p)) out.push_back(x ? p.x : p.y);
            // What is not relied on may be orders of magnitude off: it is cut at the frame.
            for (const PlotBand& b : s.band) {
                if (!b.reliable || !drawn(b)) continue;
                out.push_back(x ? b.x : b.low);
                if (!x) out.push_back(b.high);
            }
        }
        return out;
    }

    void text(const char* kind, double x, double y, const std::string& words) {
        out_ += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", kind, x, y,
                            escaped(words));
    }

    void line(const char* kind, double x0, double y0, double x1, double y1) {
        out_ += fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>", kind, x0, y0,
                            x1, y1);
    }

    void grid() {
        for (const Tick& t : x_.ticks()) {
            const double x = x_.at(t.value);
            line(t.text.empty() ? "fine" : "grid", x, top_, x, bottom_);
            if (!t.text.empty()) text("tick", x, bottom_ + 18, t.text);
        }
        for (const Tick& t : y_.ticks()) {
            const double y = y_.at(t.value);
            line(t.text.empty() ? "fine" : "grid", kLeft, y, kWidth - kRight, y);
            if (!t.text.empty()) text("tick left", kLeft - 7, y + 4, t.text);
        }
    }

    // Through the last point of the first curve, upwards.
    void guide(double slope) {
        for (const PlotSeries& s : plot_.series) {
            for (std::size_t i = s.points.size(); i-- > 0;) {
                const PlotPoint& p = s.points[i];
                if (!drawn(p)) continue;
                double x = x_.low(), y = p.y * std::pow(x / p.x, slope);
                if (y > y_.high()) y = y_.high(), x = p.x * std::pow(y / p.y, 1 / slope);
                return line("guide", x_.at(x), y_.at(y), x_.at(p.x), y_.at(p.y));
            }
        }
    }

    void floor(double v) {
        if (v < y_.low() || v > y_.high()) return;
        line("floor", kLeft, y_.at(v), kWidth - kRight, y_.at(v));
        text("tick inside", kLeft + 6, y_.at(v) - 5, "noise of the reference");
    }

    void band_part(const std::vector<PlotBand>& band, std::size_t first, std::size_t last,
                   bool reliable) {
        if (first == last) return;
        std::string path;
        for (std::size_t i = first; i <= last; ++i)
            path += fmt::format("{}{:.1f} {:.1f}", i == first ? 'M' : 'L', x_.at(band[i].x),
                                y_.at(band[i].high));
        for (std::size_t i = last + 1; i-- > first;)
            path += fmt::format("L{:.1f} {:.1f}", x_.at(band[i].x), y_.at(band[i].low));
        out_ +=
            fmt::format("<path class=\"band{}\" d=\"{}Z\"/>", reliable ? "" : " unreliable", path);
    }

    // In parts that are reliable at both their ends, and others.
    void bands(const PlotSeries& s) {
        std::vector<PlotBand> band;
        for (const PlotBand& b : s.band)
            if (drawn(b)) band.push_back(b);
        if (band.empty()) return;
        const auto sure = [&](std::size_t i) { return band[i].reliable && band[i + 1].reliable; };
        std::size_t first = 0;
        for (std::size_t i = 0; i + 1 < band.size(); ++i) {
            if (i + 2 < band.size() && sure(i + 1) == sure(first)) continue;
            band_part(band, first, i + 1, sure(first));
            first = i + 1;
        }
    }

    void series(const PlotSeries& s) {
        out_ += fmt::format("<g class=\"series c{}\">", s.colour % kPlotColours);
        bands(s);
        std::string path;
        for (const PlotPoint& p : s.points)
            if (drawn(p))
                path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', x_.at(p.x),
                                    y_.at(p.y));
        if (s.joined && !path.empty()) out_ += "<path class=\"curve\" d=\"" + path + "\"/>";
        for (const PlotPoint& p : s.points) {
            if (!drawn(p)) continue;
            if (p.low < p.y && p.high > p.y)
                line("bar", x_.at(p.x), y_.at(std::max(p.low, y_.low())), x_.at(p.x),
                     y_.at(p.high));
            marker(s, x_.at(p.x), y_.at(p.y), p.tip);
        }
        out_ += "</g>";
    }

    void marker(const PlotSeries& s, double x, double y, const std::string& tip) {
        out_ += fmt::format(
            "<path class=\"mark{}\" transform=\"translate({:.1f} {:.1f})\" d=\"{}\" "
            "data-tip=\"{}\"/>",
            s.joined ? "" : " lone", x, y, kShapes[s.colour % 4], escaped(tip));
    }

    void legend() {
        double y = bottom_ + kBottom + 14;
        for (const PlotSeries& s : plot_.series) {
            out_ += fmt::format("<g class=\"series c{}\">", s.colour % kPlotColours);
            if (s.joined) line("curve", kLeft, y - 4, kLeft + 26, y - 4);
            marker(s, kLeft + 13, y - 4, "");
            out_ += "</g>";
            text("legend", kLeft + 34, y, s.label);
            y += kLegendLine;
        }
    }

    const Plot& plot_;
    PlotUse use_;
    double top_, bottom_;
    LogAxis x_, y_;
    std::string out_;
};

}  // namespace

std::string draw_plot(const Plot& plot, PlotUse use) { return Drawing(plot, use).run(); }

}  // namespace tessera
