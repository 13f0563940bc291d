#pragma once
// One run of `tessera converge`: `tessera render` as a process, seen pass by pass.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "renderer/converge/record.h"

namespace tessera {

struct RunRequest {
    std::string program;
    bool attribute = false;  // say what makes the error, if it can
    bool passes = true;      // it knows --passes; otherwise it renders once for each point
    std::string scene, res, folder;
    std::vector<std::string> set;
    std::optional<std::uint64_t> seed;
    std::optional<int> spp;
    double time_s = 0;  // 0: no limit
    int threads = 0;
    bool external = false;
};

/// A run without true errors, and the picture of each of its points.
struct RunOutcome {
    ConvergeRun run;
    std::vector<std::string> files;
    std::uint64_t width = 0, height = 0;
};

/// Whether a program's render has --passes. Throws Error(usage) if it cannot be run.
bool knows_passes(const std::string& program, const std::atomic<bool>& stop);

/// What goes wrong is the run's failure; points that were reached are kept.
RunOutcome run_once(const RunRequest& request, const std::atomic<bool>& stop);

/// A point and what was measured once, from a statistics file. Throws Error(scene) naming it.
ConvergePoint read_point(const std::string& statistics, ConvergeRun& run);

/// The words of one render to FOLDER/NAME.exr and .json, without its limits.
std::vector<std::string> render_words(const RunRequest& request, const std::string& name);

}  // namespace tessera
