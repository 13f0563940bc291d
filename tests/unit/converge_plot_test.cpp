#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "renderer/converge/log_axis.h"
#include "renderer/converge/plot.h"
#include "renderer/converge/plot_png.h"

using namespace tessera;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

Plot plot_of(std::vector<PlotPoint> points, std::vector<PlotBand> band = {}) {
    Plot plot;
    plot.title = "title";
    plot.series.push_back({"one", 0, std::move(points), std::move(band), true});
    plot.guide = -1;
    plot.floor = 1e-3;
    return plot;
}

int labels(const LogAxis& axis) {
    int n = 0;
    for (const Tick& t : axis.ticks()) n += t.text.empty() ? 0 : 1;
    return n;
}

int count(const std::string& text, const std::string& word) {
    int n = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
        ++n;
    return n;
}

// Numbers that no viewer can read.
bool is_sound(const std::string& svg) {
    return svg.find("nan") == std::string::npos && svg.find("inf") == std::string::npos;
}

}  // namespace

TEST_CASE("log axis: all values lie within it, with room, and keep their order") {
    const LogAxis axis({0.03, 2, 500}, 100, 400);
    CHECK(axis.low() < 0.03);
    CHECK(axis.low() > 0.01);
    CHECK(axis.high() > 500);
    CHECK(axis.at(0.03) > 100);
    CHECK(axis.at(0.03) < axis.at(2));
    CHECK(axis.at(500) < 400);
    // halfway by logarithm
    CHECK(axis.at(std::sqrt(axis.low() * axis.high())) == doctest::Approx(250));
}

TEST_CASE("log axis: one value, none, or none that has a logarithm still make an axis") {
    const LogAxis one({3}, 0, 100);
    CHECK(one.low() < 3);
    CHECK(one.high() > 3);
    CHECK(one.at(3) == doctest::Approx(50));
    for (const auto& values : {std::vector<double>{}, std::vector<double>{0, -1, kNan, kInf}}) {
        const LogAxis none(values, 0, 100);
        CHECK(none.low() == doctest::Approx(0.1));
        CHECK(none.high() == doctest::Approx(10));
        CHECK(std::isfinite(none.at(kNan)));
        CHECK(none.at(0) == doctest::Approx(0));
        CHECK(none.at(kInf) == doctest::Approx(100));
    }
}

TEST_CASE("log axis: there are two to nine labels, whatever it spans") {
    for (double decades = 0; decades < 40; decades += 0.13) {
        const LogAxis axis({0.7, 0.7 * std::pow(10.0, decades)}, 0, 300);
        CAPTURE(decades);
        CHECK(labels(axis) >= 2);
        CHECK(labels(axis) <= 9);
        for (const Tick& t : axis.ticks()) {
            CHECK(t.value >= axis.low());
            CHECK(t.value <= axis.high());
        }
    }
}

TEST_CASE("log axis: ticks are written as people write them") {
    CHECK(tick_text(0.001) == "0.001");
    CHECK(tick_text(0.5) == "0.5");
    CHECK(tick_text(1) == "1");
    CHECK(tick_text(20000) == "20000");
    CHECK(tick_text(1e-5) == "10⁻⁵");
    CHECK(tick_text(2e6) == "2·10⁶");
    CHECK(tick_text(1e12) == "10¹²");
}

TEST_CASE("plot: a point for each that has logarithms, and no number that is none") {
    const std::string svg =
        draw_plot(plot_of({{1, 0.5, 0.4, 0.6, "tip <1>"},
                           {0, 1, 1, 1, "zero"},
                           {2, kNan, kNan, kNan, "nan"},
                           {4, 0.1, -1, kInf, "wide"}},
                          {{1, 0.4, 0.6, true}, {2, 0, kInf, true}, {4, 0.09, 0.12, false}}),
                  PlotUse::page);
    CHECK(is_sound(svg.substr(0, svg.find("data-tip"))));
    CHECK(count(svg, "data-tip=") == 2);
    CHECK(count(svg, "tip &lt;1&gt;") == 1);
    CHECK(count(svg, "class=\"bar\"") == 2);
    CHECK(count(svg, "class=\"band") == 1);
}

TEST_CASE("plot: parts of a band that are not relied on are marked, and join the others") {
    const std::string svg = draw_plot(plot_of({{1, 1, 1, 1, ""}}, {{1, 1, 2, false},
                                                                   {2, 1, 2, false},
                                                                   {3, 1, 2, true},
                                                                   {4, 1, 2, true},
                                                                   {5, 1, 2, true}}),
                                      PlotUse::page);
    CHECK(count(svg, "class=\"band unreliable\"") == 1);
    CHECK(count(svg, "class=\"band\"") == 1);
}

TEST_CASE("plot: what is not relied on does not stretch the axis") {
    const std::vector<PlotPoint> points{{1, 0.5, 0.5, 0.5, ""}, {4, 0.1, 0.1, 0.1, ""}};
    const std::string with = draw_plot(plot_of(points, {{1, 1e-6, 1e6, false}}), PlotUse::page);
    CHECK(with == draw_plot(plot_of(points), PlotUse::page));
}

TEST_CASE("plot: nothing at all, and a single point, are drawn too") {
    CHECK(is_sound(draw_plot(Plot{}, PlotUse::file)));
    CHECK(is_sound(draw_plot(plot_of({}), PlotUse::file)));
    CHECK(is_sound(draw_plot(plot_of({{1, 1, 1, 1, ""}}), PlotUse::file)));
}

TEST_CASE("plot: titles and labels cannot leave their text") {
    Plot plot = plot_of({{1, 1, 1, 1, "</svg><script>"}});
    plot.title = plot.series[0].label = "</text><script>\"'&";
    const std::string svg = draw_plot(plot, PlotUse::file);
    CHECK(svg.find("<script") == std::string::npos);
    CHECK(count(svg, "</svg>") == 1);
    CHECK(svg.find("&lt;/text&gt;&lt;script&gt;&quot;&#39;&amp;") != std::string::npos);
}

TEST_CASE("plot: as PNG it has the size asked for and more than one colour") {
    const std::string svg =
        draw_plot(plot_of({{1, 1, 1, 1, ""}, {10, 0.1, 0.1, 0.1, ""}}), PlotUse::file);
    const std::string png = png_of_svg(svg, 2);
    REQUIRE(png.size() > 3000);  // an empty one is smaller
    CHECK(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(png[i]); };
    CHECK(byte(18) * 256 + byte(19) == 960);
    CHECK_THROWS(png_of_svg("no svg", 1));
}
