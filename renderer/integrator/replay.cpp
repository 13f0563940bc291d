#include "renderer/integrator/replay.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "renderer/core/cpu_time.h"
#include "renderer/core/parallel.h"
#include "renderer/integrator/block.h"
#include "renderer/integrator/ray_log.h"
#include "renderer/integrator/tiles.h"

namespace tessera {
namespace {

constexpr int kTilesAtOnce = 64;

// What the error estimate renders a second time.
void log_probes(BlockJob& job, const PixelWindow& tile, BlockKernel kernel) {
    const RenderDesc& settings = job.scene->settings();
    std::vector<ProbeGrid::Pixel> probes;
    const ProbeGrid grid(tile, settings.seed);
    grid.each_inside(tile, [&](std::size_t, ProbeGrid::Pixel p) { probes.push_back(p); });
    BlockSamples samples;
    Counters counters;
    for (std::size_t first = 0; first < probes.size(); first += kLanes) {
        const std::size_t count = std::min<std::size_t>(kLanes, probes.size() - first);
        job.lanes = kAllLanes >> (kLanes - count);
        for (std::size_t i = 0; i < count; ++i)
            aim_lane(job, static_cast<int>(i), probes[first + i].x, probes[first + i].y,
                     probe_seed(settings.seed));
        for (int s = 0; s < settings.spp; ++s) {
            choose_sample(job, static_cast<std::uint32_t>(s));
            kernel(job, samples, counters);
        }
    }
}

}  // namespace

ReplayTimes time_replay(const Scene& scene, const RenderSettings& settings) {
    const FilmDesc& film = scene.film();
    const PixelWindow window = film.crop ? *film.crop : PixelWindow{0, 0, film.width, film.height};
    const std::vector<PixelWindow> tiles = make_tiles(window, settings.tile);
    const FilterSampler filter(film.filter, film.filter_width_px);
    const BlockKernel kernel = find_kernel(scene.settings().integrator, scene.kernel());
    Workers workers(settings.threads);
    ReplayTimes times;
    std::atomic<std::uint64_t> hits{0};
    for (std::size_t first = 0; first < tiles.size(); first += kTilesAtOnce) {
        const int count =
            static_cast<int>(std::min<std::size_t>(kTilesAtOnce, tiles.size() - first));
        std::vector<RayLog> logs(count);
        workers.for_each(count, [&](int t) {
            const PixelWindow& tile = tiles[first + t];
            BlockJob job;
            job.scene = &scene;
            job.filter = &filter;
            job.log = &logs[t];
            BlockSamples samples;
            Counters counters;
            for (int y = tile.y0 & ~(kBlockSize - 1); y < tile.y1; y += kBlockSize) {
                for (int x = tile.x0 & ~(kBlockSize - 1); x < tile.x1; x += kBlockSize) {
                    aim_block(job, x, y, scene.settings().seed);
                    job.lanes = lanes_inside(tile, x, y);
                    for (int s = 0; s < scene.settings().spp; ++s) {
                        choose_sample(job, static_cast<std::uint32_t>(s));
                        kernel(job, samples, counters);
                    }
                }
            }
            if (settings.error_estimate) log_probes(job, tile, kernel);
        });
        const double cpu = process_cpu_seconds();
        const auto start = std::chrono::steady_clock::now();
        workers.for_each(count, [&](int t) { hits += logs[t].replay(scene.accel()); });
        times.seconds +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        times.cpu_seconds += process_cpu_seconds() - cpu;
        for (const RayLog& log : logs) times.rays += log.rays();
    }
    return times;
}

}  // namespace tessera
