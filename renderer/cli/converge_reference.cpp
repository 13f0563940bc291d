#include "renderer/cli/converge_reference.h"

#include <fmt/format.h>

#include <filesystem>

#include "renderer/api/error.h"
#include "renderer/cli/child_process.h"
#include "renderer/cli/compare_files.h"
#include "renderer/cli/console.h"
#include "renderer/cli/converge_run.h"
#include "renderer/cli/scene_options.h"
#include "renderer/core/log.h"
#include "renderer/scene/scene.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

bool holds(const LayeredImage& image, const std::string& key, const MetadataValue& value) {
    for (const auto& [k, v] : image.metadata)
        if (k == key) return v == value;
    return false;
}

bool has(const LayeredImage& image, const std::string& key) {
    for (const auto& entry : image.metadata)
        if (entry.first == key) return true;
    return false;
}

std::string hash_of(const RunRequest& r) {
    SceneOptions o;
    o.scene = r.scene, o.set = r.set, o.res = r.res, o.seed = r.seed;
    o.threads = r.threads, o.external = r.external;
    o.aovs = {"beauty"};
    double load_s = 0;
    return build_scene(o.load(load_s), o.build_options())->hash();
}

// Whether a file is the picture that the request would make.
bool is_there(const std::string& exr, const std::string& statistics, const RunRequest& r) {
    std::error_code none;
    if (!fs::exists(exr, none) || !fs::exists(statistics, none)) return false;
    try {
        const ComparedPicture kept = read_compared(exr);
        return holds(kept.image, "tessera/spp", *r.spp) && !has(kept.image, "tessera/partial") &&
               kept.seed == std::to_string(*r.seed) && kept.scene_hash == hash_of(r);
    } catch (const Error&) {
        return false;  // whatever lies there, it is replaced
    }
}

}  // namespace

std::optional<ConvergeReference> obtain_reference(
    const PlannedScene& scene, const ConvergeOptions& o, const std::string& program,
    const std::string& folder, const std::string& file_name, const std::atomic<bool>& stop) {
    if (scene.reference.empty()) return std::nullopt;
    ConvergeReference out;
    if (!scene.reference_is_scene) {
        out.file = scene.reference;
        return out;
    }
    RunRequest r;
    r.program = program;
    r.scene = scene.reference;
    r.folder = folder;
    r.set = o.set, r.res = o.res, r.threads = o.threads, r.external = o.external;
    r.seed = kReferenceSeed;
    r.spp = o.reference_spp;
    fs::create_directories(folder);
    out.file = folder + "/" + file_name + ".exr";
    const std::string statistics = folder + "/" + file_name + ".json";
    out.scene = scene.reference;
    if (is_there(out.file, statistics, r)) {
        log_info(fmt::format("reference {}: {} is it already", scene.name, out.file));
    } else {
        log_info(fmt::format("reference {}: {} spp of {}", scene.name, *r.spp, r.scene));
        std::vector<std::string> words = render_words(r, file_name);
        words.insert(words.end(), {"--spp", std::to_string(*r.spp)});
        const ChildResult child = run_child(words, stop);
        if (stop) return std::nullopt;
        if (child.code != 0)
            throw Error(ExitCode::scene,
                        "reference of scene '" + scene.name + "': " + printable(child.err));
    }
    ConvergeRun run;
    const ConvergePoint point = read_point(statistics, run);
    out.spp = point.spp;
    out.seed = run.seed;
    out.relmse = point.relmse;
    return out;
}

}  // namespace tessera
