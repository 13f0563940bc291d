#include "renderer/cli/converge_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "renderer/api/error.h"
#include "renderer/core/nearest_name.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSeries = 64;  // of a scene

[[noreturn]] void usage(const std::string& message) { throw Error(ExitCode::usage, message); }

bool exists(const std::string& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

bool is_scene_file(const std::string& path) {
    return path.ends_with(".toml") || path.ends_with(".obj");
}

// "NAME=FILE"; a file of that very name comes first.
std::pair<std::string, std::string> named_file(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || exists(text)) return {"", text};
    return {text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<PlannedScene> scenes_of(const std::vector<std::string>& texts) {
    std::vector<PlannedScene> out;
    for (const std::string& text : texts) {
        auto [name, file] = named_file(text);
        const auto by_name = [&](const PlannedScene& s) { return s.name == name; };
        auto found = name.empty() ? out.end() : std::find_if(out.begin(), out.end(), by_name);
        if (found == out.end()) {
            if (name.empty()) {
                const fs::path path(file);
                name = path.stem().string();
                if (std::any_of(out.begin(), out.end(), by_name))
                    name = path.parent_path().filename().string() + "-" + name;
                if (std::any_of(out.begin(), out.end(), by_name))
                    usage(text + ": another scene has the name '" + name + "'; write NAME=" + file);
            }
            out.push_back({});
            found = out.end() - 1;
            found->name = name;
        }
        if (std::find(found->files.begin(), found->files.end(), file) != found->files.end())
            usage(text + ": the file is there twice");
        found->files.push_back(file);
    }
    return out;
}

PlannedScene& scene_named(std::vector<PlannedScene>& scenes, const std::string& name,
                          const std::string& option) {
    std::vector<std::string> names;
    for (PlannedScene& s : scenes) {
        if (s.name == name) return s;
        names.push_back(s.name);
    }
    usage(option + ": no scene has the name '" + name + "'" + did_you_mean(name, names));
}

// Of which scene an option's text speaks: the one before the mark, or the only one.
std::pair<PlannedScene*, std::string> addressed(std::vector<PlannedScene>& scenes,
                                                const std::string& text, char mark,
                                                const std::string& option) {
    for (PlannedScene& s : scenes)
        if (text.starts_with(s.name + mark)) return {&s, text.substr(s.name.size() + 1)};
    if (scenes.size() == 1) return {&scenes[0], text};
    usage(fmt::format("{}: of which scene? write {}{}{}", option, scenes[0].name, mark, text));
}

// Unlike that of any scene before it.
void name_file(PlannedScene& scene, const std::vector<PlannedScene>& scenes) {
    const std::string wanted = file_name_of(scene.name);
    scene.file_name = wanted;
    const auto taken = [&](const PlannedScene& other) {
        return &other < &scene && other.file_name == scene.file_name;
    };
    for (int n = 2; std::any_of(scenes.begin(), scenes.end(), taken); ++n)
        scene.file_name = fmt::format("{}-{}", wanted, n);
}

void add_references(const ConvergeOptions& o, std::vector<PlannedScene>& scenes) {
    for (const std::string& text : o.references) {
        const std::string option = "--reference " + text;
        auto [name, file] = named_file(text);
        if (name.empty() && scenes.size() > 1)
            usage(fmt::format("{}: of which scene? write {}={}", option, scenes[0].name, text));
        PlannedScene& scene = name.empty() ? scenes[0] : scene_named(scenes, name, option);
        if (!scene.reference.empty())
            usage(option + ": scene '" + scene.name + "' has the reference " + scene.reference);
        scene.reference = file;
        scene.reference_is_scene = is_scene_file(file);
        if (scene.reference_is_scene && !o.reference_spp)
            usage(option + ": is a scene; how many samples, say with --reference-spp");
    }
    for (PlannedScene& scene : scenes) {
        if (!scene.reference.empty() || !o.reference_spp) continue;
        scene.reference = scene.files[0];
        scene.reference_is_scene = true;
    }
}

std::vector<Build> builds_of(const std::vector<std::string>& texts, const std::string& own) {
    if (texts.empty()) return {{"", own}};
    std::vector<Build> out{{"this", own}};
    for (const std::string& text : texts) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
            usage("--build " + text + ": must be LABEL=PROGRAM, for example old=/tmp/old/tessera");
        const std::string label = text.substr(0, equals);
        for (const Build& b : out)
            if (b.label == label) usage("--build " + text + ": the label is taken already");
        out.push_back({label, text.substr(equals + 1)});
    }
    return out;
}

// Its stem, or all of it if another file has the same.
std::string told_apart(const std::string& file, const std::vector<std::string>& files) {
    const fs::path stem = fs::path(file).stem();
    const auto alike = std::count_if(files.begin(), files.end(), [&](const std::string& other) {
        return fs::path(other).stem() == stem;
    });
    return alike > 1 ? file : stem.string();
}

std::string series_of(const Combination& c, const PlannedScene& scene, const ConvergePlan& plan) {
    std::vector<std::string> words;
    if (scene.files.size() > 1) words.push_back(told_apart(c.scene, scene.files));
    if (!plan.builds[c.build].label.empty()) words.push_back(plan.builds[c.build].label);
    for (const auto& [key, value] : c.settings) words.push_back(key + "=" + value);
    std::string out;
    for (const std::string& w : words) out += (out.empty() ? "" : ", ") + w;
    return out.empty() ? "Tessera" : out;
}

// Every file by every build by every choice of values, the last --vary changing first.
void combine(PlannedScene& scene, const ConvergePlan& plan) {
    for (const std::string& file : scene.files) {
        std::vector<Combination> all;
        for (std::size_t b = 0; b < plan.builds.size(); ++b) all.push_back({file, b, {}, {}, ""});
        for (const Varied& v : plan.varied) {
            std::vector<Combination> more;
            for (const Combination& c : all) {
                for (std::size_t i = 0; i < v.values.size(); ++i) {
                    more.push_back(c);
                    more.back().settings.emplace_back(v.name, v.values[i]);
                    more.back().set.push_back(v.sets[i]);
                }
            }
            all = std::move(more);
        }
        scene.combinations.insert(scene.combinations.end(), all.begin(), all.end());
    }
    if (scene.combinations.size() > kMostSeries)
        usage(fmt::format("scene '{}': {} combinations; at most {} can be told apart", scene.name,
                          scene.combinations.size(), kMostSeries));
    for (Combination& c : scene.combinations) c.series = series_of(c, scene, plan);
}

void check(const ConvergeOptions& o, const ConvergePlan& plan) {
    if (o.time_s <= 0 && !o.spp) usage("converge: how far? give --time SECONDS, --spp N, or both");
    for (std::size_t i = 0; i < plan.varied.size(); ++i) {
        const Varied& v = plan.varied[i];
        for (std::size_t k = 0; k < i; ++k)
            if (plan.varied[k].name == v.name)
                usage("--vary " + v.text + ": the key is varied already");
        const std::string key = v.sets[0].substr(0, v.sets[0].find('='));
        if (key == "render.seed" && o.seeds > 1)
            usage("--vary " + v.text + ": --seeds varies the seed already");
        if (key == "render.spp")
            usage("--vary " + v.text + ": samples are what errors are plotted against");
    }
}

}  // namespace

std::string file_name_of(const std::string& text) {
    constexpr std::size_t kMost = 100;
    std::string out;
    for (const char c : text.substr(0, kMost)) {
        const bool fine = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                          (c >= 'a' && c <= 'z') || c == '.' || c == '-' || c == '_' || c == '=';
        if (fine && !(out.empty() && c == '.'))
            out += c;
        else if (!out.empty() && out.back() != '_')
            out += '_';
    }
    return out.empty() ? "scene" : out;
}

Varied parse_vary(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
        usage("--vary " + text + ": must be KEY=A,B, for example max_depth=4,8");
    Varied out;
    out.text = text;
    out.name = text.substr(0, equals);
    int depth = 0;
    bool quoted = false;
    std::string value;
    const auto take = [&] {
        if (value.empty()) usage("--vary " + text + ": a value is empty");
        if (std::find(out.values.begin(), out.values.end(), value) != out.values.end())
            usage("--vary " + text + ": '" + value + "' is there twice");
        out.values.push_back(value);
        value.clear();
    };
    for (const char c : text.substr(equals + 1)) {
        if (c == '"') quoted = !quoted;
        if (!quoted) depth += (c == '[' || c == '{') - (c == ']' || c == '}');
        if (c == ',' && depth == 0 && !quoted)
            take();
        else
            value += c;
    }
    take();
    const std::string table = out.name.find_first_of(".[\"") == std::string::npos ? "render." : "";
    for (const std::string& v : out.values) out.sets.push_back(table + out.name + "=" + v);
    return out;
}

PlannedPicture parse_timed(const std::string& text, const std::string& option, bool file) {
    const auto wrong = [&] {
        usage(option + " " + text + ": must be LABEL" + (file ? "=FILE" : "") +
              "@SECONDS, seconds above 0");
    };
    const std::size_t at = text.rfind('@');
    if (at == std::string::npos || at == 0) wrong();
    PlannedPicture out;
    const std::string number = text.substr(at + 1);
    char* end = nullptr;
    out.wall_s = std::strtod(number.c_str(), &end);
    if (number.empty() || *end != 0 || !(out.wall_s > 0) || !std::isfinite(out.wall_s)) wrong();
    out.label = text.substr(0, at);
    if (!file) return out;
    const std::size_t equals = out.label.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == out.label.size()) wrong();
    out.file = out.label.substr(equals + 1);
    out.label.resize(equals);
    return out;
}

ConvergePlan make_plan(const ConvergeOptions& o, const std::string& own) {
    ConvergePlan plan;
    plan.scenes = scenes_of(o.scenes);
    for (const std::string& text : o.vary) plan.varied.push_back(parse_vary(text));
    plan.builds = builds_of(o.builds, own);
    check(o, plan);
    add_references(o, plan.scenes);
    for (const std::string& text : o.pictures) {
        const auto [scene, rest] = addressed(plan.scenes, text, '/', "--picture " + text);
        scene->pictures.push_back(parse_timed(rest, "--picture", true));
    }
    for (const std::string& text : o.history) {
        const auto [scene, rest] = addressed(plan.scenes, text, '/', "--history " + text);
        scene->history.push_back(parse_timed(rest, "--history", false));
    }
    for (PlannedScene& scene : plan.scenes) {
        name_file(scene, plan.scenes);
        combine(scene, plan);
    }
    return plan;
}

}  // namespace tessera
