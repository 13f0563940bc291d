#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>

#include <fmt/format.h>

#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/cli/describe_picture.h"
#include "renderer/cli/error_options.h"
#include "renderer/cli/forecast_printer.h"
#include "renderer/cli/frame_window.h"
#include "renderer/cli/long_render.h"
#include "renderer/cli/output_check.h"
#include "renderer/cli/output_options.h"
#include "renderer/cli/pass_files.h"
#include "renderer/cli/picture_files.h"
#include "renderer/cli/progress.h"
#include "renderer/cli/say_error.h"
#include "renderer/cli/scene_options.h"
#include "renderer/cli/signals.h"
#include "renderer/cli/snapshots.h"
#include "renderer/cli/tev_display.h"
#include "renderer/cli/write_time.h"
#include "renderer/core/log.h"
#include "renderer/film/film_file.h"
#include "renderer/film/pass_docs.h"
#include "renderer/scene/scene.h"

namespace tessera {
namespace {

constexpr int kMostForTarget = 1 << 20;  // samples of a pixel

struct RenderOptions {
    SceneOptions scene;
    LongRenderOptions runs;
    OutputOptions out;
    std::string output, preview, view, stats, display, deep, passes;
    std::string progress = "auto", crypto_manifest = "embedded";
    double time_s = 0;
    ErrorOptions error;
    bool no_progress = false, quiet = false;
    int verbose = 0;
};

std::string count(std::uint64_t n) {
    const double v = static_cast<double>(n);
    if (n >= 1000000000) return fmt::format("{:.2f}G", v * 1e-9);
    if (n >= 1000000) return fmt::format("{:.2f}M", v * 1e-6);
    return n >= 10000 ? fmt::format("{:.1f}k", v * 1e-3) : fmt::format("{}", n);
}

void write_stats(const Statistics& s, const std::string& path) {
    if (path == "-") return print_out(to_json(s));
    write_text_file(to_json(s), path);
}

std::vector<OutputFile> outputs_of(const RenderOptions& o) {
    std::vector<OutputFile> files{{o.output, "--output", {".exr", kFilmExtension}},
                                  {o.preview, "--preview", {".png", ".jpg", ".jpeg"}},
                                  {names_film_file(o.deep) ? "" : o.deep, "--deep", {".exr"}},
                                  {o.stats == "-" ? "" : o.stats, "--stats", {}}};
    for (const OutputFile& f : o.runs.outputs(o.output)) files.push_back(f);
    return files;
}

void say_what_was_built(const Statistics& s, double load_s, bool quiet) {
    if (!quiet) {
        for (const std::string& w : s.warnings) log_warning(w);
    }
    for (const std::string& n : s.notes) log_info("note: " + n);
    log_info(fmt::format(
        "scene    {} triangles ({} instanced), {} lights, kernel {}, load {:.2f} s, build {:.2f} s",
        count(s.triangles_stored), count(s.triangles_instanced), s.lights, s.kernel, load_s,
        s.build_s));
    for (const LeftOut& l : s.left_out) log_verbose("left out " + l.what + ": " + l.why);
}

// Before it is made, so that who asks for too much knows why it ended.
void say_what_the_film_takes(const Scene& scene, const RenderOptions& o) {
    const FilmDesc& film = scene.film();
    const PixelWindow window = film.crop ? *film.crop : PixelWindow{0, 0, film.width, film.height};
    const std::uint64_t bytes =
        Film::expected_bytes(window, scene.passes(), {!o.deep.empty(), !o.error.none});
    log_info(fmt::format("film     {}x{}, beauty{}{} and {} passes, {:.1f} MiB{}", window.width(),
                         window.height(), o.error.none ? "" : " four times",
                         o.deep.empty() ? "" : ", depths", scene.passes().size(),
                         static_cast<double>(bytes) / (1 << 20),
                         o.runs.checkpoint.empty() ? "" : " and as much for checkpoints"));
}

void say_what_was_rendered(const Statistics& s) {
    const auto per_second = [&](std::uint64_t n) {
        return count(
            static_cast<std::uint64_t>(static_cast<double>(n) / std::max(s.render_s, 1e-6)));
    };
    const std::string before =
        s.resumed_spp > 0 ? fmt::format(" ({} of them before)", s.resumed_spp) : "";
    log_info(fmt::format("render   {} spp{} in {:.2f} s, {}samples/s, {}rays/s ({} threads)", s.spp,
                         before, s.render_s, per_second(s.samples), per_second(s.rays.total()),
                         s.threads));
    if (s.error.asked) log_info("error    " + to_text(s.error));
    say_causes(s.error.causes);
    if (s.error_target && !s.error_reached)
        log_warning("the error that --error asks for was not reached: " + why_not_reached(s));
    if (s.checkpoints + s.checkpoints_failed > 0)
        log_verbose(fmt::format(
            "{} checkpoints, {} failed, one every {:.3g} s; the render rested {:.3g} s for them",
            s.checkpoints, s.checkpoints_failed, s.checkpoint_every_s, s.checkpoint_s));
    if (s.textures_cached > 0)
        log_info(fmt::format(
            "textures {} files in memory, {} in the tile cache; {} of {} MiB, {} MiB read",
            s.textures_in_core, s.textures_cached, s.memory_textures >> 20, s.texture_limit >> 20,
            s.texture_bytes_read >> 20));
}

void warn_of_lost_values(const Statistics& s) {
    if (!s.first_invalid.empty()) {
        const std::uint64_t total =
            std::accumulate(s.invalid.begin(), s.invalid.end(), std::uint64_t{0});
        log_warning(fmt::format("{} invalid samples or rays were dropped; first: {}", total,
                                s.first_invalid));
    }
    if (s.texture_failures > 0) {
        log_warning(fmt::format("{} texture look-ups met tiles that cannot be read; magenta there",
                                s.texture_failures));
    }
    if (s.half_clamped > 0) {
        log_warning(
            fmt::format("{} values are beyond half's 65504 and were clamped (--float keeps them)",
                        s.half_clamped));
    }
}

// Empty when no --display is given.
std::unique_ptr<TevDisplay> open_display(const FilmDesc& film, const RenderOptions& o,
                                         ProgressPrinter& printer) {
    if (o.display.empty()) return nullptr;
    TevPicture picture{o.output, film.width, film.height, {0, 0, film.width, film.height}};
    if (film.crop) picture.window = *film.crop;
    return std::make_unique<TevDisplay>(parse_viewer_address(o.display), picture,
                                        [&printer, quiet = o.quiet](const std::string& text) {
                                            if (!quiet) printer.warn(text);
                                        });
}

ProgressStyle progress_style(const RenderOptions& o) {
    const std::vector<std::string>& styles = progress_styles();
    const auto found = std::find(styles.begin(), styles.end(), o.progress);
    const auto style = static_cast<ProgressStyle>(found - styles.begin());
    const bool silent = o.no_progress || (o.quiet && style == ProgressStyle::automatic);
    return silent ? ProgressStyle::none : style;
}

// Of the time asked for, what writing the picture leaves; 0: there is no limit.
double time_to_render(const Scene& scene, const RenderOptions& o, const PictureFiles& files) {
    if (o.time_s <= 0) return 0;
    const auto start = std::chrono::steady_clock::now();
    const double write_s = foreseen_write_time(scene, files);
    const std::chrono::duration<double> trial = std::chrono::steady_clock::now() - start;
    log_verbose(fmt::format("of {:.3g} s, {:.2g} s are kept for writing", o.time_s, write_s));
    return std::max(o.time_s - write_s - trial.count(), 1e-6);
}

RenderResult render_with_progress(const Scene& scene, const RenderOptions& o, double time_s,
                                  const Snapshots::Write& write, PassFiles* passes,
                                  ProgressPrinter& printer, TevDisplay* display) {
    Snapshots snapshots(write, printer);
    RenderSettings settings;
    settings.threads = o.scene.threads;
    settings.tile = o.scene.tile;
    settings.time_s = time_s;
    settings.deep = !o.deep.empty();
    settings.error_estimate = !o.error.none;
    settings.error_causes = o.error.causes;
    settings.target = o.error.target();
    ForecastPrinter forecasts(printer,
                              settings.target || o.time_s <= 0 ? settings.target : kUsualTarget);
    settings.on_error = [&](const ErrorPoint& p) { forecasts.show(p); };
    if (passes) settings.on_pass = [=](RenderResult&& r) { passes->write(std::move(r)); };
    settings.cancel = &stop_at_next_tile();
    settings.progress = [&](const Progress& p) { printer.show(p); };
    settings.snapshot = &snapshot_wanted();
    settings.on_snapshot = [&](RenderResult&& r) { snapshots.start(std::move(r)); };
    settings.first_sample = o.runs.first_sample;
    settings.resume = o.runs.resume;
    settings.checkpoint = o.runs.checkpoint;
    settings.checkpoint_s = o.runs.checkpoint_s;
    if (names_film_file(o.output)) settings.film_file = o.output;
    settings.warn = [&](const std::string& text) { printer.warn(text); };
    if (display) {
        settings.on_tile = [=](const PixelWindow& tile, const std::vector<Layer>& layers) {
            display->show(tile, layers);
        };
    }
    RenderResult result = render(scene, settings);
    printer.finish();
    if (display) display->show(result.image.window, result.image.layers);
    return result;
}

// A part of a picture may keep its depths in itself alone.
void check_deep(const RenderOptions& o) {
    if (!names_film_file(o.deep) || o.deep == o.output) return;
    throw Error(ExitCode::usage, "--deep " + o.deep +
                                     ": must end in .exr; the film file of --output is the only "
                                     "one that depths may go to");
}

// The deep file that the scene asks for lies beside the picture; a part keeps the depths.
void take_deep(const std::string& named, RenderOptions& o) {
    if (named.empty() || !o.deep.empty()) return;
    const auto beside = std::filesystem::path(o.output).parent_path() / named;
    o.deep = names_film_file(o.output) ? o.output : beside.string();
    check_outputs(outputs_of(o));
}

// Hours of rendering are not lost with a full disk.
WriteReport write_picture(const Snapshots::Write& write, RenderResult& result,
                          const std::string& checkpoint) {
    try {
        return write(result);
    } catch (const Error& e) {
        if (checkpoint.empty() || e.code() != ExitCode::output) throw;
        const std::string fate =
            result.stats.checkpoint_saved
                ? "the samples are in " + checkpoint + ": --resume " + checkpoint +
                      " writes the picture"
                : checkpoint + " could not be written either and lacks the last samples";
        throw Error(e.code(), std::string(e.what()) + "\n" + fate);
    }
}

int run_render(RenderOptions options, const std::string& command) {
    set_log_level(options.quiet ? LogLevel::quiet
                                : (options.verbose > 0 ? LogLevel::verbose : LogLevel::normal));
    if (options.output.empty()) {
        options.output = std::filesystem::path(options.scene.scene).stem().string() + ".exr";
        log_info("note: no -o given, the picture goes to " + options.output);
    }
    catch_signals();
    if (!options.display.empty()) parse_viewer_address(options.display);
    check_deep(options);
    if (options.progress == "tractor" && options.stats == "-")
        throw Error(ExitCode::usage,
                    "--progress tractor: standard output is that of --stats -; give it a file");
    check_outputs(outputs_of(options));
    if (options.error.target() && !options.scene.spp && options.runs.samples.empty())
        options.scene.spp = kMostForTarget;
    options.runs.apply(options.scene.spp, options.output);

    double load_s = 0;
    SceneDesc desc = options.scene.load(load_s);
    take_deep(desc.output.deep, options);
    check_outputs_spare(outputs_of(options), desc);
    options.out.apply(desc);
    check_codec(desc);
    const PictureFiles files{options.output,
                             options.preview,
                             options.view,
                             desc.output,
                             options.crypto_manifest == "sidecar",
                             options.scene.threads};
    if (files.format.exr == ExrLayout::split) check_split_spares(outputs_of(options)[0], desc);
    desc.film.crop = frame_window(desc);
    if (!options.preview.empty()) check_view(desc.film.working_space, options.view);
    const ScenePtr scene = build_scene(std::move(desc), options.scene.build_options());
    say_what_was_built(describe(*scene), load_s, options.quiet);
    say_what_the_film_takes(*scene, options);

    ProgressPrinter printer(progress_style(options));
    const auto display = open_display(scene->film(), options, printer);
    const auto describe = [&](RenderResult& r) {
        r.stats.load_s = load_s;
        describe_picture(r.image, scene->hash(), r.stats, command, files.format);
    };
    std::optional<PassFiles> passes;
    if (!options.passes.empty()) passes.emplace(options.passes, describe);
    const auto write = [&](RenderResult& r) {
        describe(r);
        WriteReport report = write_picture_files(r.image, files);
        if (r.deep && !names_film_file(options.deep))
            write_deep_file(r.image, *r.deep, options.deep,
                            write_options(files.format, options.scene.threads), report);
        return report;
    };
    RenderResult result =
        render_with_progress(*scene, options, time_to_render(*scene, options, files), write,
                             passes ? &*passes : nullptr, printer, display.get());
    Statistics& s = result.stats;
    s.load_s = load_s;
    if (!result.complete && s.samples == 0 && s.resumed_spp == 0) {
        throw Error(static_cast<ExitCode>(signal_exit_code()),
                    "stopped by a signal before anything was rendered; nothing saved");
    }
    say_what_was_rendered(s);

    const auto start = std::chrono::steady_clock::now();
    const WriteReport written = write_picture(write, result, options.runs.checkpoint);
    s.write_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    s.half_clamped = written.clamped;
    s.half_non_finite = written.non_finite;
    s.memory_peak = peak_memory();
    if (!options.stats.empty()) write_stats(s, options.stats);
    if (!options.quiet) warn_of_lost_values(s);
    log_info(fmt::format("wrote    {} ({:.1f} MiB, {:.2f} s), peak memory {} MiB{}",
                         names(written.files), static_cast<double>(written.bytes) / (1 << 20),
                         s.write_s, s.memory_peak >> 20, result.complete ? "" : ", partial"));
    if (!result.complete && s.checkpoint_saved)
        log_info("note: --resume " + options.runs.checkpoint + " goes on from here");
    if (display) display->close();
    return static_cast<int>(result.complete ? ExitCode::done : ExitCode::checkpoint);
}

}  // namespace

void add_render(Command app, CommandLine& line) {
    Command sub = app.add_command("render", "Render a scene to a layered EXR");
    auto o = std::make_shared<RenderOptions>();
    o->scene.add_to(sub);
    const auto positive_seconds = [](const std::string& text) {
        char* end = nullptr;
        const double s = std::strtod(text.c_str(), &end);
        return *end == 0 && s > 0 && s <= 1e9 ? std::string()
                                              : text + " is no number of seconds above 0";
    };
    sub.option("-o,--output", o->output,
               "The EXR to write (default: the scene's name, in the current folder), or a "
               ".tsf for tessera merge");
    sub.option("--preview", o->preview, "Also a .png or .jpg for the eye");
    sub.option("--view", o->view, "OpenColorIO view of the preview (default: the config's)");
    sub.option("--stats", o->stats, "Statistics as JSON; - for standard output");
    sub.option("--time", o->time_s, "Seconds to render; passes until they are used, --spp at most")
        .check(positive_seconds);
    o->error.add_to(sub);
    o->runs.add_to(sub);
    sub.option("--display", o->display,
               "HOST:PORT of a tev viewer that shows the picture as it grows");
    sub.option("--deep", o->deep,
               "Also a deep EXR: beauty apart by depth, for merging by depth; or the .tsf of "
               "-o, to keep depths in it for tessera merge --deep");
    o->out.add_to(sub);
    sub.option("--passes", o->passes,
               "Folder for the picture after each pass, with its statistics; not counted in any "
               "time");
    sub.print_flag(
        "--list-aovs", [] { print_out(list_of_passes()); }, "List the passes that --aov takes");
    sub.option("--crypto-manifest", o->crypto_manifest,
               "Cryptomatte's names in the header or in files beside it: embedded, sidecar")
        .one_of({"embedded", "sidecar"});
    sub.option("--progress", o->progress, "auto, bar, line, json, tractor or none")
        .one_of(progress_styles());
    sub.flag("--no-progress", o->no_progress, "As --progress none");
    sub.flag("-v,--verbose", o->verbose, "Say more");
    sub.flag("-q,--quiet", o->quiet, "Say nothing but errors");
    sub.footer(
        "Examples:\n"
        "  tessera render bunny.obj -o bunny.exr\n"
        "  tessera render scene.toml -o out.exr --time 60 --preview out.png\n"
        "  tessera render scene.toml -o crop.exr --crop 100,100,200,200 --aov Z --aov N\n"
        "  tessera render scene.toml -o comp.exr --aov compositing --aov light_groups");
    sub.when_chosen([o, &line] {
        line.run = [o, &line] {
            // With a time to fill and no count asked for, the time alone decides.
            if (o->time_s > 0 && !o->scene.spp && o->runs.samples.empty()) o->scene.spp = 1 << 24;
            return run_render(*o, line.text);
        };
    });
}

}  // namespace tessera
