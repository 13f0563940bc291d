#pragma once
// Records of `tessera converge` that were never rendered.

#include "renderer/converge/record.h"

namespace tessera {

inline ConvergePoint point_of(int spp, double wall_s, double relmse, double spread = 1.25) {
    ConvergePoint p;
    p.spp = spp;
    p.wall_s = wall_s;
    p.cpu_s = 2 * wall_s;
    p.rays = static_cast<std::uint64_t>(spp) * 1000;
    p.memory_peak = 64u << 20;
    p.relmse = Interval{relmse, relmse / spread, relmse * spread, true};
    p.rmse = Interval{relmse / 4, relmse / 4 / spread, relmse / 4 * spread, true};
    return p;
}

/// relMSE 8/spp, 0.01 s a sample; the truth is a twentieth above what it says.
inline ConvergeRun run_of(const std::string& series, std::uint64_t seed = 0, double scale = 1) {
    ConvergeRun run;
    run.series = series;
    run.scene = "box.toml";
    run.version = "1.2.3";
    run.integrator = "path";
    run.kernel = "basic";
    run.isa = "avx2";
    run.seed = seed;
    run.threads = 2;
    run.complete = true;
    for (const int spp : {4, 8, 16, 32, 64}) {
        run.curve.push_back(point_of(spp, 0.01 * spp, scale * 8 / spp));
        run.curve.back().truth = TrueError{scale * 2.1 / spp, scale * 8.4 / spp, 0.5 / spp};
    }
    return run;
}

inline ConvergeReport report_of(const std::string& name) {
    ConvergeReport report;
    report.version = "1.2.3";
    report.command = "tessera converge " + name;
    report.date = "2026-01-02 03:04 UTC";
    report.host = "host", report.cpu = "cpu", report.system = "system";
    report.threads = 2, report.spp = 64;
    ConvergeScene scene;
    scene.name = name;
    scene.width = 32, scene.height = 16;
    scene.reference = ConvergeReference{"r.exr", "box.toml", 4096, 7, std::nullopt, {}};
    scene.runs = {run_of("a=1"), run_of("a=2", 0, 2)};
    scene.runs[0].shown = {64, 0.64, "\x89PNG one", "map", "map"};
    scene.runs[1].shown = {64, 0.64, "\x89PNG two", "map", "map"};
    scene.history = {{"then", 4440}};
    report.scenes = {scene};
    return report;
}

}  // namespace tessera
