#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "renderer/io/scene_document.h"
#include "renderer/io/scene_toml.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const std::string& path) {
    std::string extension = fs::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

void check_file(const std::string& path) {
    std::error_code failed;
    const fs::file_status status = fs::status(path, failed);
    if (!fs::exists(status)) throw Error(ExitCode::scene, "scene '" + path + "' not found");
    if (!fs::is_regular_file(status))
        throw Error(ExitCode::scene, "scene '" + path + "' is not a regular file");
}

/// The folder a scene lies in once links are followed.
std::string real_folder(const std::string& path) {
    std::error_code failed;
    return fs::weakly_canonical(fs::absolute(path, failed), failed).parent_path().string();
}

/// What a scene file that shows one OBJ would say.
Value document_of_obj(const std::string& path) {
    const SourceLoc loc{std::make_shared<const std::string>(path), 0, 0};
    const Value mesh{Table{{"file", Value{fs::path(path).filename().string(), loc}}}, loc};
    return {Table{{"tessera", Value{std::int64_t(1), loc}}, {"mesh", Value{List{mesh}, loc}}}, loc};
}

void light_the_dark(SceneDesc& scene, bool bare_obj, Problems& problems) {
    if (has_emitter(scene, !bare_obj)) return;
    if (bare_obj) {
        // A sky alone leaves a white model shapeless; the key light comes from above the automatic
        // camera, a little to its left.
        scene.environment = EnvironmentDesc{};
        scene.environment->radiance = {0.5f, 0.5f, 0.5f};
        DistantLightDesc key;
        key.direction = {0.35, -1.0, -0.75};
        key.irradiance = {1.5f, 1.5f, 1.5f};
        key.angle_deg = 20;
        LightDesc light;
        light.name = "key";
        light.visible = false;
        light.shape = key;
        scene.lights.push_back(light);
        problems.note({},
                      scene.path +
                          ": no light in it; lit by a neutral sky of radiance 0.5 and a soft key "
                          "light of irradiance 1.5");
    } else {
        problems.warn({}, scene.path +
                              ": nothing in it emits light, the picture will be black (add an "
                              "[environment], a [[light]] or a material's emission_luminance)");
    }
}

}  // namespace

SceneDesc load_scene(const std::string& path, const LoadOptions& options) {
    const std::string extension = lower_extension(path);
    const bool bare_obj = extension == ".obj";
    if (!bare_obj && extension != ".toml") {
        throw Error(ExitCode::usage, "scene '" + path + "' is neither .toml nor .obj");
    }
    check_file(path);
    const std::string folder =
        (fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".").string();
    AssetRules assets(folder, options.allow_external_assets);
    assets.add_root(real_folder(path));
    Problems problems(options.strictness);

    std::vector<std::string> files;
    Value document = bare_obj ? document_of_obj(path) : read_document(path, assets, files);
    for (const std::string& assignment : options.set)
        apply_set(document, assignment, scene_keys(), problems);
    SceneDesc scene = read_scene(std::move(document), path, folder, assets, problems);
    light_the_dark(scene, bare_obj, problems);
    problems.throw_if_any();

    scene.files.insert(scene.files.begin(), files.begin(), files.end());
    scene.warnings = problems.warnings();
    scene.notes = problems.notes();
    return scene;
}

}  // namespace tessera
