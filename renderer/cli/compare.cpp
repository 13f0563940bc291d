#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "renderer/cli/commands.h"
#include "renderer/cli/compare_report.h"
#include "renderer/cli/console.h"
#include "renderer/cli/output_check.h"
#include "renderer/compare/heat_map.h"
#include "renderer/core/log.h"
#include "renderer/image/atomic_file.h"
#include "renderer/image/eight_bit.h"

namespace tessera {
namespace {

struct CompareCommand {
    std::string a, b, reference, json, heatmap, heatmap_metric = "relative";
    std::vector<std::string> layers, fail_above, fail_below;
    std::optional<double> epsilon;
    double pixels_per_degree = kPixelsPerDegree;
    int threads = 0;
    bool ignore_non_finite = false, quiet = false;
};

std::vector<Limit> limits_of(const CompareCommand& o) {
    std::vector<Limit> limits;
    for (const std::string& text : o.fail_above) limits.push_back(parse_limit(text, true));
    for (const std::string& text : o.fail_below) limits.push_back(parse_limit(text, false));
    return limits;
}

CompareRequest request_of(const CompareCommand& o) {
    CompareRequest request;
    request.sides.push_back(expand_files(o.a));
    const std::vector<std::string> b = expand_files(o.b);
    if (!o.reference.empty()) {
        request.sides.push_back(b);
        request.reference = o.reference;
    } else if (b.size() > 1) {
        throw Error(ExitCode::usage, o.b + ": without --reference, B is the reference, one file");
    } else {
        request.reference = b[0];
    }
    request.layers = o.layers;
    request.epsilon = o.epsilon;
    request.pixels_per_degree = o.pixels_per_degree;
    request.maps = !o.heatmap.empty();
    request.threads = o.threads;
    return request;
}

void check_spares(const CompareCommand& o, const CompareRequest& request) {
    check_outputs({{o.json == "-" ? "" : o.json, "--json", {}},
                   {o.heatmap, "--heatmap", {".png", ".jpg", ".jpeg"}}});
    std::vector<std::string> inputs{request.reference};
    for (const auto& side : request.sides) inputs.insert(inputs.end(), side.begin(), side.end());
    for (const std::string& input : inputs) {
        for (const std::string& output : {o.json, o.heatmap}) {
            std::error_code none;
            if (!output.empty() && std::filesystem::equivalent(input, output, none))
                throw Error(ExitCode::usage,
                            output + ": would replace one of the pictures; give another name");
        }
    }
}

void write_text(const std::string& text, const std::string& path) {
    if (path == "-") return print_out(text);
    AtomicFile file(path);
    file.write(text.data(), text.size());
    file.finish();
    file.commit();
}

// A and, to its right, B.
void write_heat_map(const CompareCommand& o, const ErrorMaps& maps) {
    const bool flip = o.heatmap_metric == "flip";
    const auto& sides = flip ? maps.flip : maps.relative;
    if (std::any_of(sides.begin(), sides.end(), [](const auto& map) { return map.empty(); }))
        throw Error(ExitCode::usage, "--heatmap: there is no " + o.heatmap_metric + " map of '" +
                                         maps.layer + "' (--layer chooses another layer)");
    const auto width = static_cast<std::size_t>(maps.width);
    std::vector<std::uint8_t> picture;
    std::vector<std::vector<std::uint8_t>> colours;
    for (const auto& map : sides) colours.push_back(heat_map(flip ? map : on_log_scale(map)));
    for (std::size_t y = 0; y < static_cast<std::size_t>(maps.height); ++y)
        for (const auto& side : colours)
            picture.insert(picture.end(), side.begin() + static_cast<std::ptrdiff_t>(y * width * 3),
                           side.begin() + static_cast<std::ptrdiff_t>((y + 1) * width * 3));
    write_eight_bit(picture, maps.width * static_cast<int>(sides.size()), maps.height, o.heatmap);
    log_info(fmt::format(
        "wrote    {}: {} of '{}'{}, {}", o.heatmap, flip ? "FLIP" : "relative error", maps.layer,
        sides.size() > 1 ? ", A and B" : "",
        flip ? "black 0 to white 1" : "black at most 0.1 % to white at least 1000 %, logarithmic"));
}

int run_compare(const CompareCommand& o) {
    set_log_level(o.quiet ? LogLevel::quiet : LogLevel::normal);
    const std::vector<Limit> limits = limits_of(o);
    const CompareRequest request = request_of(o);
    check_spares(o, request);
    const Comparison comparison = compare_pictures(request);
    const std::vector<std::string> failures = exceeded(comparison, limits, o.ignore_non_finite);
    if (!o.quiet && o.json != "-") print_out(as_text(comparison));
    if (!o.json.empty()) write_text(as_json(comparison, limits, failures), o.json);
    if (!o.heatmap.empty()) write_heat_map(o, comparison.maps);
    for (const std::string& line : failures) print_err("compare: " + printable(line) + "\n");
    return static_cast<int>(failures.empty() ? ExitCode::done : ExitCode::differs);
}

}  // namespace

void add_compare(Command app, CommandLine& line) {
    Command sub = app.add_command("compare", "Measure how far pictures are from a reference");
    auto o = std::make_shared<CompareCommand>();
    sub.option("a", o->a, "A picture, or several of other seeds: a_1.exr,a_2.exr or 'a_*.exr'")
        .required();
    sub.option("b", o->b, "The picture to compare it with; with --reference as A").required();
    sub.option("--reference", o->reference, "What both are measured against (default: B)");
    sub.option("--layer", o->layers, "Compare this layer only, for example beauty (repeatable)")
        .one_each();
    sub.option("--fail-above", o->fail_above,
               "Exit code 10 if a metric is greater: METRIC=VALUE or LAYER:METRIC=VALUE "
               "(repeatable); rmse, relmse, trimmed_relmse, flip, max_abs, bias, different, "
               "non_finite")
        .one_each();
    sub.option("--fail-below", o->fail_below, "Exit code 10 if it is less: psnr, ssim (repeatable)")
        .one_each();
    sub.flag("--ignore-non-finite", o->ignore_non_finite,
             "NaN and infinite pixels, which are left out, fail no limit");
    sub.option("--heatmap", o->heatmap, "A .png or .jpg of the errors, of the first layer");
    sub.option("--heatmap-metric", o->heatmap_metric, "relative (default) or flip")
        .one_of({"relative", "flip"});
    sub.option("--json", o->json, "The results as JSON; - is standard output");
    sub.option("--epsilon", o->epsilon,
               "Of relMSE (default: 0.01 times the square of the reference's mean)")
        .in(0.0, 1e30);
    sub.option("--ppd", o->pixels_per_degree, "Pixels per degree of sight, for FLIP (default 67)")
        .in(5.0, 500.0);
    sub.option("-t,--threads", o->threads, "Worker threads (default: all there are)")
        .in(-1024, 1024);
    sub.flag("-q,--quiet", o->quiet, "Say nothing but errors and exceeded limits");
    sub.footer(
        "Examples:\n"
        "  tessera compare new.exr old.exr --heatmap difference.png\n"
        "  tessera compare farm.exr workstation.exr --fail-above different=0\n"
        "  tessera compare 'a_*.exr' 'b_*.exr' --reference long.exr\n"
        "Exit codes: 0 compared, and no limit exceeded; 10 a limit is exceeded; 3 a file cannot be "
        "read or compared");
    sub.when_chosen([o, &line] { line.run = [o] { return run_compare(*o); }; });
}

}  // namespace tessera
