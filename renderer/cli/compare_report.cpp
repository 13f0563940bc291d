#include "renderer/cli/compare_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "renderer/cli/console.h"

namespace tessera {
namespace {

using Table = std::vector<std::vector<std::string>>;

constexpr PerMetric<const char*> kTitles{"RMSE", "relMSE",  "trimmed", "PSNR",   "SSIM",
                                         "FLIP", "max abs", "bias",    "differ", "not finite"};
constexpr Metric kJudged[] = {Metric::rmse, Metric::relmse, Metric::trimmed_relmse,
                              Metric::psnr, Metric::ssim,   Metric::flip};

std::size_t width_of(const std::string& text) {  // in characters, of UTF-8
    std::size_t n = 0;
    for (const char c : text) n += (static_cast<unsigned char>(c) & 0xC0) != 0x80;
    return n;
}

std::string aligned(const Table& table) {
    std::vector<std::size_t> widths;
    for (const auto& row : table) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t c = 0; c < row.size(); ++c)
            widths[c] = std::max(widths[c], width_of(row[c]));
    }
    std::string out;
    for (const auto& row : table) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += row[c] + std::string(widths[c] - width_of(row[c]) + 2, ' ');
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + "\n";
    }
    return out;
}

std::string shown(double v, Metric metric) {
    if (metric == Metric::different) return fmt::format("{:.3g} %", 100 * v);
    if (metric == Metric::non_finite) return fmt::format("{:.6g}", v);
    if (metric == Metric::psnr) return std::isinf(v) ? "inf" : fmt::format("{:.2f}", v);
    return metric == Metric::ssim ? fmt::format("{:.5f}", v) : fmt::format("{:.3g}", v);
}

bool is_judged(Metric metric) {
    return std::find(std::begin(kJudged), std::end(kJudged), metric) != std::end(kJudged);
}

std::string cell(const std::optional<SeedInterval>& i, Metric metric) {
    if (!i) return "-";
    std::string text = shown(i->mean, metric);
    if (i->count > 1 && std::isfinite(i->mean) && is_judged(metric))
        text += fmt::format(" ±{:.2g}", (i->high - i->low) / 2);
    return text;
}

// The ratios of means show the bias; the last column stands only where there is something in it.
std::vector<Metric> columns_of(const Comparison& comparison) {
    std::vector<Metric> columns(std::begin(kJudged), std::end(kJudged));
    columns.insert(columns.end(), {Metric::max_abs, Metric::different});
    for (const ComparedLayer& layer : comparison.layers)
        for (const SideScores& side : layer.sides)
            if (const auto& bad = side.values[static_cast<std::size_t>(Metric::non_finite)];
                bad && bad->mean > 0 && columns.back() != Metric::non_finite)
                columns.push_back(Metric::non_finite);
    return columns;
}

std::string side_name(std::size_t s) { return s == 0 ? "A" : "B"; }

std::string ratios(const SideScores& side) {
    std::string text;
    for (const ChannelScores& c : side.channels)
        if (c.mean_ratio)
            text += fmt::format("{}{} {:.4f}", text.empty() ? "" : "  ", c.name, *c.mean_ratio);
    return text.empty() ? "-" : text;
}

Table table_of(const Comparison& comparison) {
    std::vector<std::string> head{"layer"};
    const bool both = comparison.sides.size() > 1;
    if (both) head.emplace_back("");
    const std::vector<Metric> columns = columns_of(comparison);
    for (const Metric m : columns) head.emplace_back(kTitles[static_cast<std::size_t>(m)]);
    head.emplace_back("mean ratio");
    Table table{head};
    for (const ComparedLayer& layer : comparison.layers) {
        for (std::size_t s = 0; s < layer.sides.size(); ++s) {
            std::vector<std::string> row{s == 0 ? printable(layer.title) : ""};
            if (both) row.push_back(side_name(s));
            for (const Metric m : columns)
                row.push_back(cell(layer.sides[s].values[static_cast<std::size_t>(m)], m));
            row.push_back(printable(ratios(layer.sides[s])));
            table.push_back(row);
        }
    }
    return table;
}

std::string files_text(const std::vector<std::string>& files) {
    if (files.size() == 1) return printable(files[0]);
    return printable(files[0]) + fmt::format(" and {} more (±: 95 % interval over {} seeds)",
                                             files.size() - 1, files.size());
}

Table header_of(const Comparison& c) {
    Table table;
    for (std::size_t s = 0; s < c.sides.size(); ++s)
        table.push_back({side_name(s), files_text(c.sides[s])});
    table.push_back({c.sides.size() > 1 ? "reference" : "B, reference", printable(c.reference)});
    const std::string space = c.working_space.empty() ? "unknown primaries" : c.working_space;
    table.push_back({"values", fmt::format("{} x {} pixels, {}", c.width, c.height,
                                           c.encoded ? "integers, taken as sRGB from 0 to 1"
                                                     : "linear light, " + space)});
    return table;
}

std::string count_text(const ValueCounts& n) {
    std::string text;
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    };
    add(n.nan, "NaN"), add(n.infinite, "infinite"), add(n.negative, "negative");
    return text;
}

// Values that a picture should not have, channel by channel; negative ones of colours only.
std::string odd_values(const Comparison& c) {
    std::string out;
    const auto say = [&](const ComparedLayer& layer, const std::string& channel,
                         const std::string& who, ValueCounts n) {
        if (layer.content != LayerContent::colour) n.negative = 0;
        const std::string text = count_text(n);
        if (!text.empty())
            out += printable(fmt::format("values     '{}' {} of {}: {}", layer.title, channel, who,
                                         text)) +
                   "\n";
    };
    for (const ComparedLayer& layer : c.layers) {
        if (layer.content == LayerContent::ids) continue;
        for (std::size_t s = 0; s < layer.sides.size(); ++s)
            for (const ChannelScores& n : layer.sides[s].channels)
                say(layer, n.name, side_name(s), n.a);
        for (const ChannelScores& n : layer.sides[0].channels)
            say(layer, n.name, c.sides.size() > 1 ? "the reference" : "B", n.reference);
    }
    return out;
}

Closer verdict(const ComparedLayer& layer, Metric metric) {
    const auto &a = layer.sides[0].values[static_cast<std::size_t>(metric)],
               &b = layer.sides[1].values[static_cast<std::size_t>(metric)];
    return a && b ? closer(*a, *b, less_is_closer(metric)) : Closer::unknown;
}

std::string verdict_line(const ComparedLayer& layer) {
    std::string a, b, none;
    for (const Metric m : kJudged) {
        if (!layer.sides[0].values[static_cast<std::size_t>(m)]) continue;
        const Closer who = verdict(layer, m);
        std::string& list = who == Closer::a ? a : who == Closer::b ? b : none;
        list += (list.empty() ? "" : ", ") + std::string(kTitles[static_cast<std::size_t>(m)]);
    }
    std::string text;
    const auto add = [&](const std::string& what, const std::string& list) {
        if (!list.empty()) text += (text.empty() ? "" : "; ") + what + " by " + list;
    };
    add("A is closer", a), add("B is closer", b), add("no difference can be told", none);
    return text.empty() ? "" : fmt::format("verdict    '{}': {}\n", printable(layer.title), text);
}

std::string verdicts(const Comparison& c) {
    if (c.sides.size() < 2) return {};
    if (!c.seeds)
        return "verdict    none: which is closer can be told from several files of other seeds a "
               "side\n";
    std::string out;
    for (const ComparedLayer& layer : c.layers)
        if (layer.content != LayerContent::ids) out += verdict_line(layer);
    return out;
}

}  // namespace

std::string as_text(const Comparison& c) {
    std::string out = aligned(header_of(c)) + "\n" + aligned(table_of(c)) + "\n";
    out += odd_values(c);
    for (const LonePart& part : c.lone)
        out += printable("only in    " + part.file + ": " + part.name) + "\n";
    for (const std::string& n : c.notes) out += printable("note       " + n) + "\n";
    out += verdicts(c);
    while (out.ends_with("\n\n")) out.pop_back();
    return out;
}

}  // namespace tessera
