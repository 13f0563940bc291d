#include "renderer/cli/converge_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "renderer/api/error.h"
#include "renderer/cli/converge_pictures.h"
#include "renderer/cli/converge_reference.h"
#include "renderer/cli/converge_run.h"
#include "renderer/cli/scene_options.h"
#include "renderer/converge/summary.h"
#include "renderer/converge/text.h"
#include "renderer/core/log.h"
#include "renderer/error/cause_text.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr double kClose = 4;  // times the reference's own error, below which it counts

SceneDesc load(const std::string& file, const std::vector<std::string>& set,
               const ConvergeOptions& o) {
    SceneOptions options;
    options.scene = file;
    options.set = o.set;
    options.set.insert(options.set.end(), set.begin(), set.end());
    options.res = o.res;
    options.external = o.external;
    double load_s = 0;
    return options.load(load_s);
}

void check_varied(const std::string& file, const Varied& v, const ConvergeOptions& o) {
    for (const std::string& set : v.sets) {
        try {
            load(file, {set}, o);
        } catch (const Error& e) {
            throw Error(ExitCode::usage, "--vary " + v.text + ": " + e.what());
        }
    }
}

void check_frame(const std::string& picture, const std::string& option, const PlannedScene& scene,
                 const CheckedScene& checked) {
    const PictureFrame frame = frame_of(picture);
    if (frame.encoded)
        throw Error(ExitCode::scene, fmt::format("{}: has integers for a display, errors need "
                                                 "floats of light, as EXR has ({})",
                                                 picture, option));
    if (frame.width == checked.width && frame.height == checked.height) return;
    throw Error(ExitCode::scene, fmt::format("{}: is {} x {} pixels, scene '{}' is {} x {} ({})",
                                             picture, frame.width, frame.height, scene.name,
                                             checked.width, checked.height, option));
}

// Nearest in time, by its logarithm.
std::size_t nearest(const std::vector<ConvergePoint>& curve, double wall_s) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double distance = std::fabs(std::log(curve[i].wall_s / wall_s));
        if (distance < least) least = distance, best = i;
    }
    return best;
}

std::string said(const ConvergeRun& run) {
    if (run.curve.empty()) return "nothing was rendered";
    const ConvergePoint& p = run.curve.back();
    std::string text = fmt::format("{} spp in {}", p.spp, duration(p.wall_s));
    if (const auto e = error_at(p, ErrorKind::relmse))
        text += fmt::format(", relMSE {}{}", three_figures(*e), p.truth ? "" : " by itself");
    return text;
}

}  // namespace

struct SceneRuns::Kept {
    std::size_t run;
    std::vector<std::string> files;
};

CheckedScene check_scene(const PlannedScene& scene, const ConvergePlan& plan,
                         const ConvergeOptions& o) {
    CheckedScene out;
    for (const std::string& file : scene.files) {
        const SceneDesc desc = load(file, {}, o);
        if (out.width > 0 && (desc.film.width != out.width || desc.film.height != out.height))
            throw Error(ExitCode::scene,
                        fmt::format("{}: is {} x {} pixels, {} of the same scene is {} x {} (--res "
                                    "gives both one size)",
                                    file, desc.film.width, desc.film.height, scene.files[0],
                                    out.width, out.height));
        out.width = desc.film.width, out.height = desc.film.height;
        out.seeds.push_back(desc.render.seed);
        for (const Varied& v : plan.varied) check_varied(file, v, o);
    }
    if (!scene.reference.empty() && !scene.reference_is_scene)
        check_frame(scene.reference, "--reference", scene, out);
    if (scene.reference_is_scene) {
        const SceneDesc desc = load(scene.reference, {}, o);
        if (desc.film.width != out.width || desc.film.height != out.height)
            throw Error(
                ExitCode::scene,
                fmt::format("{}: is {} x {} pixels, scene '{}' is {} x {} (--res gives both "
                            "one size)",
                            scene.reference, desc.film.width, desc.film.height, scene.name,
                            out.width, out.height));
    }
    for (const PlannedPicture& p : scene.pictures) check_frame(p.file, "--picture", scene, out);
    return out;
}

ConvergeScene SceneRuns::run(const std::string& work, std::vector<std::string>& failures) {
    work_ = work;
    out_.name = scene_.name;
    out_.file_name = scene_.file_name;
    out_.width = checked_.width, out_.height = checked_.height;
    for (const PlannedPicture& h : scene_.history) out_.history.push_back({h.label, h.wall_s});
    try {
        out_.reference = obtain_reference(scene_, options_, plan_.builds[0].program,
                                          options_.output + "/references", scene_.file_name, stop_);
        if (out_.reference) out_.reference->shown = shown(out_.reference->file);
    } catch (const Error& e) {
        failures.push_back(e.what());
        log_warning(e.what());
    }
    std::vector<Kept> kept;
    for (const Combination& c : scene_.combinations)
        if (!stop_) run_series(c, kept, failures);
    show(kept);
    add_pictures(failures);
    return std::move(out_);
}

void SceneRuns::run_series(const Combination& c, std::vector<Kept>& kept,
                           std::vector<std::string>& failures) {
    const Build& build = plan_.builds[c.build];
    for (int k = 0; k < options_.seeds && !stop_; ++k) {
        RunRequest r;
        r.program = build.program;
        r.passes = passes_[c.build];
        r.attribute = options_.attribute;
        r.scene = c.scene;
        r.res = options_.res;
        r.set = options_.set;
        r.set.insert(r.set.end(), c.set.begin(), c.set.end());
        r.spp = options_.spp, r.time_s = options_.time_s;
        r.threads = options_.threads, r.external = options_.external;
        const auto file = std::find(scene_.files.begin(), scene_.files.end(), c.scene);
        if (k > 0)
            r.seed = checked_.seeds[static_cast<std::size_t>(file - scene_.files.begin())] +
                     static_cast<std::uint64_t>(k);
        r.folder = fmt::format("{}/{}-{}", work_, out_.runs.size(), k);
        RunOutcome outcome;
        try {
            outcome = run_once(r, stop_);
            outcome.run.series = c.series;
            measure_run(outcome.run, outcome.files);
        } catch (const Error& e) {
            outcome.run.failure = e.what();
        }
        ConvergeRun& run = outcome.run;
        run.series = c.series, run.build = build.label, run.settings = c.settings;
        run.scene = c.scene;
        if (r.seed) run.seed = *r.seed;
        const std::string name = fmt::format("{}, {}, seed {}", scene_.name, run.series, run.seed);
        if (!run.failure.empty()) {
            failures.push_back(name + ": " + run.failure);
            log_warning(name + ": " + run.failure);
        }
        log_info(fmt::format("run      {}: {}", name, said(run)));
        if (!run.causes.empty()) log_info("cause    " + to_text(run.causes.front()));
        if (!outcome.files.empty()) keep_picture(run, outcome.files.back(), k);
        out_.runs.push_back(std::move(run));
        const bool first = std::none_of(kept.begin(), kept.end(), [&](const Kept& other) {
            return out_.runs[other.run].series == c.series;
        });
        std::error_code ignored;
        if (first && !outcome.files.empty())
            kept.push_back({out_.runs.size() - 1, std::move(outcome.files)});
        else
            fs::remove_all(r.folder, ignored);
    }
}

void SceneRuns::measure_run(ConvergeRun& run, const std::vector<std::string>& files) {
    if (!out_.reference) return;
    for (std::size_t i = 0; i < files.size(); ++i)
        run.curve[i].truth =
            measure(files[i], out_.reference->file, options_.threads, false, work_).truth;
    const auto& own = out_.reference->relmse;
    if (run.curve.empty() || !own) return;
    const std::string note =
        "errors below " + three_figures(kClose * own->value) +
        " are partly the reference's own: give it more samples (--reference-spp)";
    if (run.curve.back().truth->relmse < kClose * own->value &&
        std::find(out_.notes.begin(), out_.notes.end(), note) == out_.notes.end())
        out_.notes.push_back(note);
}

// Under a name of its own.
void SceneRuns::keep_picture(ConvergeRun& run, const std::string& file, int seed_number) {
    const std::string folder = options_.output + "/pictures";
    fs::create_directories(folder);
    std::string name = scene_.file_name + "-" + file_name_of(run.series);
    if (options_.seeds > 1) name += fmt::format("-{}", seed_number + 1);
    for (const ConvergeRun& other : out_.runs)
        if (other.file == folder + "/" + name + ".exr")
            name += fmt::format("-{}", out_.runs.size());
    run.file = folder + "/" + name + ".exr";
    std::error_code failed;
    fs::copy_file(file, run.file, fs::copy_options::overwrite_existing, failed);
    if (failed) throw Error(ExitCode::output, run.file + ": cannot write: " + failed.message());
}

// Each series as it was when the quickest of them ended.
void SceneRuns::show(const std::vector<Kept>& kept) {
    double wall = std::numeric_limits<double>::infinity();
    for (const Kept& k : kept) wall = std::min(wall, out_.runs[k.run].curve.back().wall_s);
    for (const Kept& k : kept) {
        ConvergeRun& run = out_.runs[k.run];
        const std::size_t i = nearest(run.curve, wall);
        run.shown = shown(k.files[i]);
        run.shown.spp = run.curve[i].spp;
        run.shown.wall_s = run.curve[i].wall_s;
    }
}

void SceneRuns::add_pictures(std::vector<std::string>& failures) {
    for (const PlannedPicture& p : scene_.pictures) {
        ForeignPicture picture{p.label, p.file, p.wall_s, std::nullopt, {}};
        try {
            if (out_.reference)
                picture.truth =
                    measure(p.file, out_.reference->file, options_.threads, false, work_).truth;
            picture.shown = shown(p.file);
            picture.shown.wall_s = p.wall_s;
        } catch (const Error& e) {
            failures.push_back(e.what());
            log_warning(e.what());
        }
        out_.pictures.push_back(std::move(picture));
    }
}

ShownPicture SceneRuns::shown(const std::string& file) const {
    ShownPicture out;
    out.picture = as_png(file, work_);
    if (!out_.reference || file == out_.reference->file) return out;
    Measured maps = measure(file, out_.reference->file, options_.threads, true, work_);
    out.relative = std::move(maps.relative);
    out.flip = std::move(maps.flip);
    return out;
}

}  // namespace tessera
