#include <CLI/CLI.hpp>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fmt/format.h>

#include "renderer/cli/commands.h"
#include "renderer/cli/output_check.h"
#include "renderer/cli/progress.h"
#include "renderer/cli/scene_options.h"
#include "renderer/core/log.h"
#include "renderer/scene/scene.h"

namespace tessera {
namespace {

struct RenderOptions {
    SceneOptions scene;
    std::string output, preview, view, stats;
    double time_s = 0;
    bool all_float = false, no_progress = false, quiet = false;
    int verbose = 0;
};

// Set by the handler, read by the tiles. The second signal ends the program at once.
std::atomic<bool> g_cancel{false};
volatile std::sig_atomic_t g_signal = 0;

extern "C" void on_signal(int number) {
    if (g_signal != 0) _exit(128 + number);
    g_signal = number;
    g_cancel.store(true, std::memory_order_relaxed);
}

void catch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    for (int s : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old {};
        sigaction(s, nullptr, &old);
        if (old.sa_handler != SIG_IGN) sigaction(s, &action, nullptr);  // nohup stays nohup
    }
}

void stop_if_signalled() {
    if (g_signal != 0) throw Error(static_cast<ExitCode>(128 + g_signal), "stopped by a signal before anything was rendered; nothing saved");
}

std::string count(std::uint64_t n) {
    const double v = static_cast<double>(n);
    if (n >= 1000000000) return fmt::format("{:.2f}G", v * 1e-9);
    if (n >= 1000000) return fmt::format("{:.2f}M", v * 1e-6);
    return n >= 10000 ? fmt::format("{:.1f}k", v * 1e-3) : fmt::format("{}", n);
}

void describe_in_header(LayeredImage& image, const Scene& scene, const Statistics& s, const std::string& command) {
    auto& m = image.metadata;
    m.emplace_back("tessera/version", s.version);
    m.emplace_back("tessera/scene", s.scene);
    m.emplace_back("tessera/sceneHash", scene.hash());
    m.emplace_back("tessera/spp", s.spp);
    m.emplace_back("tessera/seed", std::to_string(s.seed));
    m.emplace_back("tessera/seconds", static_cast<float>(s.render_s));
    m.emplace_back("tessera/threads", s.threads);
    m.emplace_back("tessera/embreeIsa", s.isa);
    m.emplace_back("tessera/colorSpace", scene.film().working_space);
    m.emplace_back("tessera/command", command);
    if (!s.complete) m.emplace_back("tessera/partial", 1);
}

void write_stats(const Statistics& s, const std::string& path) {
    const std::string temporary = path + ".tmp." + std::to_string(getpid());
    std::ofstream file(temporary, std::ios::binary);
    file << to_json(s);
    file.close();
    std::error_code error;
    if (file) std::filesystem::rename(temporary, path, error);
    if (!file || error) {
        std::filesystem::remove(temporary, error);
        throw Error(ExitCode::output, path + ": cannot write the statistics");
    }
}

int run_render(const RenderOptions& options, const std::string& command) {
    set_log_level(options.quiet ? LogLevel::quiet : (options.verbose > 0 ? LogLevel::verbose : LogLevel::normal));
    const auto check = [](const std::string& path, const char* option) {
        if (!path.empty()) check_output(path, option);
    };
    check(options.output, "--output");
    check(options.preview, "--preview");
    check(options.stats, "--stats");
    catch_signals();

    double load_s = 0;
    SceneDesc desc = options.scene.load(load_s);
    stop_if_signalled();
    const ScenePtr scene = build_scene(std::move(desc), options.scene.build_options());
    stop_if_signalled();
    const Statistics built = describe(*scene);
    if (!options.quiet) {
        for (const std::string& w : built.warnings) log_warning(w);
    }
    for (const std::string& n : built.notes) log_info("note: " + n);
    log_info(fmt::format("scene    {} triangles ({} instanced), {} lights, kernel {}, load {:.2f} s, build {:.2f} s",
                         count(built.triangles_stored), count(built.triangles_instanced), built.lights, built.kernel, load_s, built.build_s));
    for (const LeftOut& l : built.left_out) log_verbose("left out " + l.what + ": " + l.why);

    ProgressPrinter printer(!options.no_progress && !options.quiet);
    RenderSettings settings;
    settings.threads = options.scene.threads;
    settings.tile = options.scene.tile;
    settings.time_s = options.time_s;
    settings.cancel = &g_cancel;
    settings.progress = [&](const Progress& p) { printer.show(p); };
    RenderResult result = render(*scene, settings);
    printer.finish();
    Statistics& s = result.stats;
    s.load_s = load_s;
    log_info(fmt::format("render   {} spp in {:.2f} s, {}samples/s, {}rays/s ({} threads)", s.spp, s.render_s,
                         count(static_cast<std::uint64_t>(static_cast<double>(s.samples) / s.render_s)),
                         count(static_cast<std::uint64_t>(static_cast<double>(s.rays.total()) / s.render_s)), s.threads));

    const auto start = std::chrono::steady_clock::now();
    describe_in_header(result.image, *scene, s, command);
    const WriteReport written = write_exr(result.image, options.output, {options.all_float});
    if (!options.preview.empty()) write_preview(result.image, options.preview, options.view);
    s.write_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    s.half_clamped = written.clamped;
    s.half_non_finite = written.non_finite;
    s.memory_peak = peak_memory();
    if (!options.stats.empty()) write_stats(s, options.stats);
    if (!s.first_invalid.empty() && !options.quiet) {
        std::uint64_t total = 0;
        for (std::uint64_t n : s.invalid) total += n;
        log_warning(fmt::format("{} invalid samples or rays were dropped; first: {}", total, s.first_invalid));
    }
    if (written.clamped > 0 && !options.quiet) {
        log_warning(fmt::format("{} values are beyond half's 65504 and were clamped (--float keeps them)", written.clamped));
    }
    log_info(fmt::format("wrote    {} ({:.1f} MiB, {:.2f} s), peak memory {} MiB{}", options.output, static_cast<double>(written.bytes) / (1 << 20),
                         s.write_s, s.memory_peak >> 20, result.complete ? "" : ", partial"));
    return static_cast<int>(result.complete ? ExitCode::done : ExitCode::checkpoint);
}

}  // namespace

void add_render(CLI::App& app, CommandLine& line) {
    CLI::App* sub = app.add_subcommand("render", "Render a scene to a layered EXR");
    auto o = std::make_shared<RenderOptions>();
    o->scene.add_to(*sub);
    sub->add_option("-o,--output", o->output, "The EXR to write")->required();
    sub->add_option("--preview", o->preview, "Also a .png or .jpg for the eye");
    sub->add_option("--view", o->view, "OpenColorIO view of the preview (default: the config's)");
    sub->add_option("--stats", o->stats, "Statistics as JSON");
    sub->add_option("--time", o->time_s, "Seconds to render; passes until they are used, --spp at most")->check(CLI::PositiveNumber);
    sub->add_flag("--float", o->all_float, "All channels as 32-bit float");
    sub->add_flag("--no-progress", o->no_progress, "No progress on stderr");
    sub->add_flag("-v,--verbose", o->verbose, "Say more");
    sub->add_flag("-q,--quiet", o->quiet, "Say nothing but errors");
    sub->footer("Examples:\n"
                "  tessera render bunny.obj -o bunny.exr\n"
                "  tessera render scene.toml -o out.exr --time 60 --preview out.png\n"
                "  tessera render scene.toml -o crop.exr --crop 100,100,200,200 --aov Z --aov N");
    sub->callback([o, &line] {
        line.run = [o, &line] {
            // With a time to fill and no count asked for, the time alone decides.
            if (o->time_s > 0 && !o->scene.spp) o->scene.spp = 1 << 24;
            return run_render(*o, line.text);
        };
    });
}

}  // namespace tessera
