#pragma once
// What `tessera converge` has seen: scenes, runs of them, points of their curves.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/api/picture_error.h"

namespace tessera {

/// Of beauty against a reference, as `tessera compare` has them.
struct TrueError {
    double rmse = 0, relmse = 0, flip = 0;
};

/// A run at the end of a pass. Seconds are of rendering alone.
struct ConvergePoint {
    int spp = 0;
    double wall_s = 0;
    std::optional<double> cpu_s;
    std::uint64_t rays = 0, memory_peak = 0;
    std::optional<Interval> rmse, relmse;  // by its own estimate
    std::optional<TrueError> truth;
};

/// A picture of the report. Each is a whole PNG or JPEG file; empty: there is none.
struct ShownPicture {
    int spp = 0;  // 0: unknown
    double wall_s = 0;
    std::string picture, relative, flip;  // the last two are heat maps
};

struct ConvergeRun {
    std::string series;  // runs of one series differ by their seed only
    std::string build;   // a label; "": this program
    std::vector<std::pair<std::string, std::string>> settings;
    std::string scene;  // file
    std::uint64_t seed = 0;
    std::string version, integrator, kernel, isa;
    int threads = 0;
    bool complete = false;
    std::string failure;  // "": none
    std::vector<std::string> cautions;
    std::vector<ErrorCause> causes;    // at the end; by --attribute, or of what is unreliable
    std::vector<ConvergePoint> curve;  // of rising samples
    std::string file;                  // the last picture
    ShownPicture shown;                // of the first run of a series
};

/// A picture of any renderer.
struct ForeignPicture {
    std::string label, file;
    double wall_s = 0;
    std::optional<TrueError> truth;
    ShownPicture shown;
};

/// A time on record of which there is no picture.
struct HistoryRow {
    std::string label;
    double wall_s = 0;
};

struct ConvergeReference {
    std::string file, scene;  // scene: what it was rendered from, "" where it was given
    int spp = 0;
    std::uint64_t seed = 0;
    std::optional<Interval> relmse;  // its own error, which nothing here can be told below
    ShownPicture shown;
};

struct ConvergeScene {
    std::string name, file_name;  // the second as a part of names of files
    int width = 0, height = 0;
    std::optional<ConvergeReference> reference;
    std::vector<ConvergeRun> runs;
    std::vector<ForeignPicture> pictures;
    std::vector<HistoryRow> history;
    std::vector<std::string> notes;
};

struct ConvergeReport {
    std::string version, command, date, host, cpu, system;
    int threads = 0;
    int spp = 0;        // limits; 0: none
    double time_s = 0;  // likewise
    int seeds = 1;
    bool complete = true;  // false: stopped by a signal
    std::vector<ConvergeScene> scenes;
    std::vector<std::string> failures;
};

}  // namespace tessera
