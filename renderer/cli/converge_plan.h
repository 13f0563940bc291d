#pragma once
// What `tessera converge` is asked to do: which scenes, by which settings and builds.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tessera {

struct ConvergeOptions {
    std::vector<std::string> scenes, vary, builds, pictures, history, references, set;
    std::string res, output;
    std::optional<int> spp, reference_spp;
    double time_s = 0;
    int seeds = 1, threads = 0;
    bool external = false, quiet = false, attribute = false;
};

/// Words of a --vary: a key of the scene file and its values.
struct Varied {
    std::string text;                       // as it was given
    std::string name;                       // of the key, as it was given
    std::vector<std::string> values, sets;  // sets: "render.max_depth=4"
};

struct Build {
    std::string label, program;  // label "": there is only this one
};

/// Settings that a scene is run with.
struct Combination {
    std::string scene;  // file
    std::size_t build = 0;
    std::vector<std::pair<std::string, std::string>> settings;
    std::vector<std::string> set;
    std::string series;
};

struct PlannedPicture {
    std::string label, file;
    double wall_s = 0;
};

struct PlannedScene {
    std::string name, file_name;
    std::vector<std::string> files;
    std::string reference;  // a picture, or a scene to render; "": there is none
    bool reference_is_scene = false;
    std::vector<PlannedPicture> pictures, history;  // history has no files
    std::vector<Combination> combinations;
};

struct ConvergePlan {
    std::vector<PlannedScene> scenes;
    std::vector<Varied> varied;
    std::vector<Build> builds;  // this one first
};

/// KEY=A,B: at commas outside of brackets and quotes; a key without a table is one of [render].
/// Throws Error(usage).
Varied parse_vary(const std::string& text);

/// LABEL=FILE@SECONDS, or LABEL@SECONDS where there is no file. Throws Error(usage).
PlannedPicture parse_timed(const std::string& text, const std::string& option, bool file);

/// A name that a file may have.
std::string file_name_of(const std::string& text);

/// Reads no scene. own: this program. Throws Error(usage).
ConvergePlan make_plan(const ConvergeOptions& options, const std::string& own);

}  // namespace tessera
