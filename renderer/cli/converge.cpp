#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "renderer/api/error.h"
#include "renderer/cli/child_process.h"
#include "renderer/cli/commands.h"
#include "renderer/cli/converge_run.h"
#include "renderer/cli/converge_scene.h"
#include "renderer/cli/machine.h"
#include "renderer/cli/pass_files.h"
#include "renderer/cli/signals.h"
#include "renderer/converge/plot_png.h"
#include "renderer/converge/report.h"
#include "renderer/core/log.h"
#include "renderer/core/parallel.h"
#include "renderer/image/atomic_file.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr double kPngScale = 2;  // pixels a unit

// Gone when it is done with.
class WorkFolder {
public:
    explicit WorkFolder(std::string path) : path_(std::move(path)) { make_folder(path_); }
    ~WorkFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    WorkFolder(const WorkFolder&) = delete;
    WorkFolder& operator=(const WorkFolder&) = delete;

    const std::string& path() const noexcept { return path_; }

    static void make_folder(const std::string& path) {
        std::error_code failed;
        fs::create_directories(path, failed);
        if (failed) fail_output(path, failed.message());
    }

private:
    std::string path_;
};

void write_plots(const ConvergeScene& scene, const std::string& folder) {
    const std::vector<SeriesSummary> series = summarise(scene);
    for (const ErrorKind kind : kErrorKinds) {
        for (const PlotAxis axis : kPlotAxes) {
            const Plot plot = make_plot(scene, series, kind, axis);
            if (plot.series.empty()) continue;
            const std::string name =
                fmt::format("{}/{}-{}-{}", folder, scene.file_name, key_of(kind),
                            axis == PlotAxis::wall ? "wall" : "spp");
            const std::string svg = draw_plot(plot, PlotUse::file);
            write_text_file(svg, name + ".svg");
            write_text_file(png_of_svg(svg, kPngScale), name + ".png");
        }
    }
}

void write_report(const ConvergeReport& report, const std::string& folder) {
    WorkFolder::make_folder(folder + "/plots");
    for (const ConvergeScene& s : report.scenes) write_plots(s, folder + "/plots");
    write_text_file(report_csv(report), folder + "/curves.csv");
    write_text_file(report_json(report), folder + "/report.json");
    write_text_file(report_html(report), folder + "/report.html");
    log_info("wrote    " + folder + "/report.html, report.json, curves.csv, plots");
}

ConvergeReport begun(const ConvergeOptions& o, const std::string& command) {
    const Machine machine = this_machine();
    ConvergeReport r;
    r.version = TESSERA_VERSION;
    r.command = command;
    r.date = date_and_time();
    r.host = machine.host, r.cpu = machine.cpu, r.system = machine.system;
    r.threads = o.threads > 0 ? o.threads : std::max(1, available_threads().threads + o.threads);
    r.spp = o.spp.value_or(0), r.time_s = o.time_s, r.seeds = o.seeds;
    return r;
}

int run_converge(ConvergeOptions o, const std::string& command) {
    set_log_level(o.quiet ? LogLevel::quiet : LogLevel::normal);
    catch_signals();
    const ConvergePlan plan = make_plan(o, own_program());
    ConvergeReport report = begun(o, command);
    const WorkFolder work(fmt::format("{}/.work.{}", o.output, ::getpid()));
    const std::atomic<bool>& stop = stop_at_next_tile();
    std::vector<bool> passes;
    for (const Build& b : plan.builds)
        passes.push_back(b.program == plan.builds[0].program || knows_passes(b.program, stop));
    for (std::size_t i = 0; i < plan.scenes.size(); ++i) {
        const PlannedScene& scene = plan.scenes[i];
        if (stop) break;
        try {
            const CheckedScene checked = check_scene(scene, plan, o);
            const WorkFolder own(fmt::format("{}/{}", work.path(), i));
            SceneRuns runs(scene, checked, plan, o, passes, stop);
            report.scenes.push_back(runs.run(own.path(), report.failures));
        } catch (const Error& e) {
            if (e.code() != ExitCode::scene) throw;
            report.failures.push_back("scene '" + scene.name + "': " + e.what());
            log_warning(report.failures.back());
        }
    }
    report.complete = !stop;
    write_report(report, o.output);
    if (stop) return static_cast<int>(ExitCode::checkpoint);
    return static_cast<int>(report.failures.empty() ? ExitCode::done : ExitCode::scene);
}

}  // namespace

void add_converge(Command app, CommandLine& line) {
    Command sub = app.add_command(
        "converge", "Render scenes by several settings or builds, and report error against time");
    auto o = std::make_shared<ConvergeOptions>();
    const auto positive = [](const std::string& text) {
        char* end = nullptr;
        const double s = std::strtod(text.c_str(), &end);
        return *end == 0 && s > 0 && s <= 1e9 ? std::string()
                                              : text + " is no number of seconds above 0";
    };
    sub.option("scenes", o->scenes, "SCENE or NAME=SCENE; files of one name are one scene")
        .required();
    sub.option("-o,--output", o->output, "Folder of the report").required();
    sub.option("--time", o->time_s, "Seconds of each run").check(positive);
    sub.option("-s,--spp", o->spp, "Samples per pixel of each run, at most").in(1, 1 << 24);
    sub.option("--reference", o->references,
               "[NAME=]FILE: a picture that errors are measured against, or a scene to render it "
               "from (repeatable)")
        .one_each();
    sub.option("--reference-spp", o->reference_spp,
               "Samples per pixel of references that are rendered: of all scenes without a picture")
        .in(1, 1 << 24);
    sub.option("--vary", o->vary,
               "KEY=A,B: each run with each value; a key without a table is one of [render] "
               "(repeatable)")
        .one_each();
    sub.option("--build", o->builds, "LABEL=PROGRAM: another tessera too (repeatable)").one_each();
    sub.option("--picture", o->pictures,
               "[NAME/]LABEL=FILE@SECONDS: a picture of any renderer (repeatable)")
        .one_each();
    sub.option("--history", o->history,
               "[NAME/]LABEL@SECONDS: a time on record, a row of the table (repeatable)")
        .one_each();
    sub.option("--seeds", o->seeds, "Runs of each, by so many seeds: intervals (default 1)")
        .in(1, 1000);
    sub.flag("--attribute", o->attribute,
             "Say which paths, lights and materials make the error of each run");
    sub.option("--set", o->set, "KEY=VALUE of the scene file, for all runs (repeatable)")
        .one_each();
    sub.option("-r,--res", o->res, "Resolution WxH of all runs");
    sub.option("-t,--threads", o->threads, "Worker threads (default: all there are)")
        .in(-1024, 1024);
    sub.flag("--allow-external-assets", o->external, "Assets may lie outside the scene's folders");
    sub.flag("-q,--quiet", o->quiet, "Say nothing but what fails");
    sub.footer(
        "Examples:\n"
        "  tessera converge cornell.toml --time 30 --reference-spp 16384 -o out\n"
        "  tessera converge cornell.toml glass.toml --spp 1024 --vary max_depth=4,8 --seeds 4 -o "
        "out\n"
        "  tessera converge cornell.toml --time 30 --build old=/opt/old/tessera \\\n"
        "      --picture other=other.exr@31.5 --reference reference.exr -o out\n"
        "Exit codes: 0 done; 3 a scene or a run failed, the report has the others; 75 stopped, the "
        "report has what there was");
    sub.when_chosen([o, &line] { line.run = [o, &line] { return run_converge(*o, line.text); }; });
}

}  // namespace tessera
