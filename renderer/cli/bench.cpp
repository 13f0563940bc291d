#include <algorithm>
#include <chrono>
#include <memory>

#include <fmt/format.h>

#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/cli/coverage.h"
#include "renderer/cli/scene_options.h"
#include "renderer/core/cpu_time.h"
#include "renderer/core/log.h"
#include "renderer/integrator/replay.h"

namespace tessera {
namespace {

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v.size() % 2 ? v[v.size() / 2] : 0.5 * (v[v.size() / 2 - 1] + v[v.size() / 2]);
}

struct BenchOptions {
    SceneOptions scene;
    CoverageOptions coverage;
    bool replay = false, no_estimate = false;
    int repeats = 5;
};

int run_bench(const BenchOptions& o) {
    double load_s = 0;
    const ScenePtr scene = build_scene(o.scene.load(load_s), o.scene.build_options());
    RenderSettings settings;
    settings.threads = o.scene.threads;
    settings.tile = o.scene.tile;
    settings.error_estimate = !o.no_estimate;
    std::vector<double> render_s, replay_s, ratio, cpu_ratio;
    Statistics stats;
    render(*scene, settings);  // warm
    for (int i = 0; i < o.repeats; ++i) {
        const double cpu = process_cpu_seconds();
        const RenderResult r = render(*scene, settings);
        const double render_cpu = process_cpu_seconds() - cpu;
        stats = r.stats;
        render_s.push_back(r.stats.render_s);
        if (!o.replay) continue;
        const ReplayTimes t = time_replay(*scene, settings);
        replay_s.push_back(t.seconds);
        ratio.push_back(r.stats.render_s / t.seconds);
        cpu_ratio.push_back(render_cpu / t.cpu_seconds);
    }
    const double s = median(render_s);
    std::string text;
    text +=
        fmt::format("scene      {} at {}x{}, {} spp, {} threads, tile {}, kernel {}\n", stats.scene,
                    stats.width, stats.height, stats.spp, stats.threads, stats.tile, stats.kernel);
    text += fmt::format("render     {:.3f} s (min {:.3f}, max {:.3f}, {} runs)\n", s,
                        *std::min_element(render_s.begin(), render_s.end()),
                        *std::max_element(render_s.begin(), render_s.end()), o.repeats);
    text += fmt::format("samples/s  {:.3f} M\n", static_cast<double>(stats.samples) / s * 1e-6);
    text += fmt::format(
        "rays/s     {:.3f} M (per sample: camera {:.2f}, bounce {:.2f}, shadow {:.2f})\n",
        static_cast<double>(stats.rays.total()) / s * 1e-6,
        static_cast<double>(stats.rays.camera) / static_cast<double>(stats.samples),
        static_cast<double>(stats.rays.bounce) / static_cast<double>(stats.samples),
        static_cast<double>(stats.rays.shadow) / static_cast<double>(stats.samples));
    if (o.replay) {
        text += fmt::format("embree     {:.3f} s for the same rays\n", median(replay_s));
        text += fmt::format("traversal ratio {:.3f} (min {:.3f}, max {:.3f})\n", median(ratio),
                            *std::min_element(ratio.begin(), ratio.end()),
                            *std::max_element(ratio.begin(), ratio.end()));
        text += fmt::format("by CPU seconds  {:.3f} (min {:.3f}, max {:.3f})\n", median(cpu_ratio),
                            *std::min_element(cpu_ratio.begin(), cpu_ratio.end()),
                            *std::max_element(cpu_ratio.begin(), cpu_ratio.end()));
    }
    print_out(text);
    return 0;
}

}  // namespace

void add_bench(Command app, CommandLine& line) {
    Command sub =
        app.add_command("bench", "Time the rendering of a scene, loading and writing left out");
    auto o = std::make_shared<BenchOptions>();
    o->scene.add_to(sub);
    sub.flag("--replay", o->replay,
             "Also time Embree alone on the very same rays: the traversal ratio");
    sub.flag("--no-error-estimate", o->no_estimate, "Without what tells the error");
    sub.option("--coverage", o->coverage.seeds,
               "Instead: renders by so many seeds, and how often the intervals of their errors "
               "hold the true ones")
        .in(2, 1 << 20);
    sub.option("--reference-spp", o->coverage.reference_spp,
               "Samples per pixel of what --coverage takes for the truth")
        .in(4, 1 << 24);
    sub.option("--repeats", o->repeats, "Timed runs").in(1, 1000);
    sub.when_chosen([o, &line] {
        line.run = [o] {
            return o->coverage.seeds > 0 ? run_coverage(o->scene, o->coverage) : run_bench(*o);
        };
    });
}

}  // namespace tessera
