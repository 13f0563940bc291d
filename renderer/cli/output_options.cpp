#include "renderer/cli/output_options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>

#include "renderer/film/pass.h"

namespace tessera {
namespace {

constexpr std::array kLayouts{"single", "multipart", "split"};
constexpr std::array kCodecs{"none", "zips", "zip", "piz", "dwaa", "dwab"};

[[noreturn]] void usage(const std::string& message) { throw Error(ExitCode::usage, message); }

template <class E, std::size_t n>
void choose(const std::string& text, const std::array<const char*, n>& names, E& out) {
    for (std::size_t i = 0; i < n; ++i)
        if (text == names[i]) out = static_cast<E>(i);
}

// "0.1" is a share, "16px" are pixels.
void parse_overscan(const std::string& text, FilmDesc& film) {
    const char* const end = text.data() + text.size();
    double number = -1;
    const auto [stop, code] = std::from_chars(text.data(), end, number);
    const std::string unit(stop, end);
    const bool pixels = unit == "px";
    const bool good = code == std::errc() && (pixels || unit.empty()) && number >= 0 &&
                      number <= (pixels ? 16384 : 1) &&
                      (!pixels || number == static_cast<int>(number));
    if (!good)
        usage("--overscan " + text +
              ": must be a share of the frame from 0 to 1, or whole pixels up to 16384px");
    film.overscan = pixels ? 0 : number;
    film.overscan_px = pixels ? static_cast<int>(number) : 0;
}

}  // namespace

void OutputOptions::add_to(Command app) {
    add_format_to(app);
    app.option("--overscan", overscan,
               "Render beyond each edge of the frame: 0.1 of its size, or 16px");
}

void OutputOptions::add_format_to(Command app) {
    app.option("--exr", exr,
               "single: one part; multipart: a part per layer; split: a file per layer, <aov> "
               "in -o stands for its name")
        .one_of({"single", "multipart", "split"});
    app.option("--compression", compression,
               "none, zips, zip (default), piz; dwaa, dwab: lossy, for colour only")
        .one_of({"none", "zips", "zip", "piz", "dwaa", "dwab"});
    app.option("--dwa-level", dwa_level, "Loss of dwaa and dwab (default 45)").in(0.0, 1000.0);
    app.flag("--float", all_float, "All channels as 32-bit float");
    app.flag("--crop-pad", crop_pad, "The whole frame, black where nothing was rendered");
    app.flag("--deterministic-metadata", deterministic,
             "No date, host, time, threads or command line in the header");
}

void OutputOptions::apply(SceneDesc& scene) const {
    OutputDesc& o = scene.output;
    choose(exr, kLayouts, o.exr);
    choose(compression, kCodecs, o.compression);
    if (dwa_level) o.dwa_level = *dwa_level;
    o.all_float = o.all_float || all_float;
    o.crop_pad = o.crop_pad || crop_pad;
    const char* const epoch = std::getenv("SOURCE_DATE_EPOCH");
    o.deterministic_metadata = o.deterministic_metadata || deterministic || (epoch && *epoch);
    if (!overscan.empty()) parse_overscan(overscan, scene.film);
}

WriteOptions write_options(const OutputDesc& output, int threads) {
    WriteOptions options;
    options.all_float = output.all_float;
    options.threads = std::max(threads, 0);
    options.layout = output.exr;
    options.compression = output.compression;
    options.dwa_level = static_cast<float>(output.dwa_level);
    return options;
}

void check_codec(const SceneDesc& scene) {
    const OutputDesc& o = scene.output;
    const bool lossy =
        o.compression == ExrCompression::dwaa || o.compression == ExrCompression::dwab;
    if (!lossy) return;
    const std::string codec = kCodecs[static_cast<std::size_t>(o.compression)];
    if (o.all_float)
        usage("--compression " + codec + ": stores colours as halves, --float has no use with it");
    if (o.exr != ExrLayout::single) return;
    const Passes passes = choose_passes(scene.film.aovs, {"default"}, scene.film.aovs_loc);
    const auto data = std::find_if(passes.begin(), passes.end(),
                                   [](const Pass& p) { return p.kind == LayerKind::data; });
    if (data == passes.end()) return;
    usage("--compression " + codec + ": would damage '" + (data->name.empty() ? "Z" : data->name) +
          "'" +
          ", and a single-part file has one codec; use --exr multipart or split, where data stays "
          "lossless, or ask for colour passes only (--aov)");
}

}  // namespace tessera
