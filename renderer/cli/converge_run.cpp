#include "renderer/cli/converge_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "renderer/api/error.h"
#include "renderer/cli/child_process.h"
#include "renderer/cli/console.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kFirstSamples = 4;  // of a program without --passes: the least that has an estimate
constexpr const char* kLast = "last";

// What is infinite is null in a file.
std::optional<Interval> interval_of(const json& j) {
    if (!j.is_object()) return std::nullopt;
    const auto number = [&](const char* key) {
        const json v = j.value(key, json());
        return v.is_number() ? v.get<double>() : std::numeric_limits<double>::infinity();
    };
    return Interval{number("value"), number("low"), number("high"), j.value("reliable", false)};
}

json beauty_of(const json& statistics) {
    const json error = statistics.value("error", json::object());
    return error.is_object() ? error.value("beauty", json()) : json();
}

std::vector<ErrorCause> causes_of(const json& list) {
    std::vector<ErrorCause> out;
    for (const json& c : list)
        out.push_back({c.at("paths"), c.at("light"), c.at("seen"), c.at("through"), c.at("share"),
                       c.at("remedy")});
    return out;
}

// The last lines of what it said; without a word, its exit code.
std::string reason(const ChildResult& child) {
    std::string text = child.err;
    while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
    constexpr std::size_t kMost = 600;
    if (text.size() > kMost) text = "... " + text.substr(text.size() - kMost);
    if (child.code > 128)
        text += (text.empty() ? "" : "; ") + fmt::format("ended by signal {}", child.code - 128);
    return printable(text.empty() ? fmt::format("exit code {}", child.code) : text);
}

std::string exr_of(const std::string& statistics) {
    return fs::path(statistics).replace_extension(".exr").string();
}

void add(RunOutcome& out, const std::string& statistics) {
    const ConvergePoint point = read_point(statistics, out.run);
    if (!out.run.curve.empty() && out.run.curve.back().spp == point.spp) {
        out.run.curve.pop_back();
        out.files.pop_back();
    }
    out.run.curve.push_back(point);
    out.files.push_back(exr_of(statistics));
}

void collect_passes(const RunRequest& request, RunOutcome& out) {
    std::vector<std::string> found;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(request.folder + "/passes", none))
        if (entry.path().extension() == ".json") found.push_back(entry.path().string());
    std::sort(found.begin(), found.end());
    for (const std::string& statistics : found) add(out, statistics);
}

class Runner {
public:
    Runner(const RunRequest& request, const std::atomic<bool>& stop)
        : request_(request), stop_(stop) {}

    RunOutcome run() {
        fs::create_directories(request_.folder);
        if (request_.passes)
            all_at_once();
        else
            step_by_step();
        const bool nothing = out_.run.curve.empty() && out_.run.failure.empty() && !stop_;
        if (nothing) out_.run.failure = "no pass was finished";
        return std::move(out_);
    }

private:
    void all_at_once() {
        std::vector<std::string> words = limited(kLast, request_.spp, true);
        words.insert(words.end(), {"--passes", request_.folder + "/passes"});
        const bool done = render(words);
        collect_passes(request_, out_);
        if (done) add(out_, statistics(kLast));
    }

    void step_by_step() {
        const int most = request_.spp.value_or(1 << 24);
        for (int spp = std::min(kFirstSamples, most);;) {
            const std::string name = fmt::format("{:06}", spp);
            if (!render(limited(name, spp, false))) return;
            add(out_, statistics(name));
            if (spp >= most) return;
            const int next = std::min(2 * spp, most);
            const double wall = out_.run.curve.back().wall_s;
            if (request_.time_s > 0 && wall / spp * next > request_.time_s) break;
            spp = next;
        }
        if (render(limited(kLast, request_.spp, true))) add(out_, statistics(kLast));
    }

    std::vector<std::string> limited(const std::string& name, std::optional<int> spp,
                                     bool time) const {
        std::vector<std::string> words = render_words(request_, name);
        if (spp) words.insert(words.end(), {"--spp", std::to_string(*spp)});
        if (time && request_.time_s > 0)
            words.insert(words.end(), {"--time", fmt::format("{}", request_.time_s)});
        return words;
    }

    std::string statistics(const std::string& name) const {
        return request_.folder + "/" + name + ".json";
    }

    // Whether it came to its end.
    bool render(const std::vector<std::string>& words) {
        if (stop_) return false;
        const ChildResult child = run_child(words, stop_);
        if (child.code == 0) return out_.run.complete = true;
        out_.run.complete = false;
        if (!stop_) out_.run.failure = reason(child);
        return false;
    }

    const RunRequest& request_;
    const std::atomic<bool>& stop_;
    RunOutcome out_;
};

}  // namespace

std::vector<std::string> render_words(const RunRequest& r, const std::string& name) {
    const std::string file = r.folder + "/" + name;
    std::vector<std::string> words{
        r.program,     "render",        r.scene,         "-o",
        file + ".exr", "--stats",       file + ".json",  "--aov",
        "beauty",      "--float",       "--compression", "none",
        "-q",          "--no-progress", "--threads",     std::to_string(r.threads)};
    if (!r.res.empty()) words.insert(words.end(), {"--res", r.res});
    for (const std::string& s : r.set) words.insert(words.end(), {"--set", s});
    if (r.seed) words.insert(words.end(), {"--seed", std::to_string(*r.seed)});
    if (r.attribute && r.passes) words.push_back("--error-causes");
    if (r.external) words.push_back("--allow-external-assets");
    return words;
}

bool knows_passes(const std::string& program, const std::atomic<bool>& stop) {
    const ChildResult help = run_child({program, "render", "--help"}, stop);
    if (help.code != 0)
        throw Error(ExitCode::usage, program + ": is no tessera ('render --help' ended with " +
                                         std::to_string(help.code) + ")");
    return help.out.find("--passes") != std::string::npos;
}

RunOutcome run_once(const RunRequest& request, const std::atomic<bool>& stop) {
    return Runner(request, stop).run();
}

ConvergePoint read_point(const std::string& statistics, ConvergeRun& run) {
    try {
        std::ifstream file(statistics);
        const json j = json::parse(file);
        const json beauty = beauty_of(j);
        ConvergePoint p;
        p.spp = j.at("spp");
        p.wall_s = j.at("seconds").at("render");
        p.rays = j.at("rays").at("total");
        p.memory_peak = j.at("memory_bytes").at("peak");
        run.version = j.at("version");
        run.integrator = j.at("integrator");
        run.kernel = j.at("kernel");
        run.isa = j.value("embree_isa", "");
        run.threads = j.at("threads");
        run.seed = j.at("seed");
        if (!beauty.is_object()) return p;
        p.rmse = interval_of(beauty.value("rmse", json()));
        p.relmse = interval_of(beauty.value("relmse", json()));
        run.cautions = beauty.value("cautions", std::vector<std::string>());
        run.causes = causes_of(beauty.value("causes", json::array()));
        const json curve = beauty.value("curve", json::array());
        if (!curve.empty() && curve.back().value("spp", 0) == p.spp)
            p.cpu_s = curve.back().at("cpu");
        return p;
    } catch (const json::exception& e) {
        throw Error(ExitCode::scene, statistics + ": is not what a render states: " + e.what());
    }
}

}  // namespace tessera
