#include "renderer/cli/output_check.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "renderer/api/error.h"
#include "renderer/image/atomic_file.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPlaceholder = "<aov>";

std::string lower_extension(const std::string& path) {
    std::string extension = fs::path(path).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

void check_extension(const OutputFile& output) {
    const std::vector<std::string>& known = output.extensions;
    const std::string extension = lower_extension(output.path);
    if (known.empty() || std::find(known.begin(), known.end(), extension) != known.end()) return;
    std::string message = std::string(output.option) + " " + output.path + ": must end in ";
    for (std::size_t i = 0; i < known.size(); ++i) message += (i ? " or " : "") + known[i];
    if (known[0] == ".exr" &&
        (extension == ".png" || extension == ".jpg" || extension == ".jpeg")) {
        const std::string exr = fs::path(output.path).replace_extension(".exr").string();
        message +=
            "; a picture for the eye comes beside it: -o " + exr + " --preview " + output.path;
    }
    throw Error(ExitCode::usage, message);
}

fs::path real_path(const std::string& path) {
    std::error_code error;
    const fs::path real = fs::weakly_canonical(fs::absolute(path, error), error);
    return error ? fs::path(path) : real;
}

std::vector<std::string> inputs_of(const SceneDesc& scene) {
    std::vector<std::string> inputs = scene.files;
    inputs.push_back(scene.path);
    for (const TextureDesc& texture : scene.textures) inputs.push_back(texture.file);
    if (const auto& e = scene.environment) {
        inputs.insert(inputs.end(), {e->file, e->camera, e->lighting, e->reflection});
        inputs.insert(inputs.end(), e->faces.begin(), e->faces.end());
    }
    for (const MaterialDesc& m : scene.materials) {
        if (m.reflection_map) inputs.push_back(m.reflection_map->file);
    }
    return inputs;
}

}  // namespace

void check_outputs(const std::vector<OutputFile>& outputs) {
    for (const OutputFile& output : outputs) {
        if (output.path.empty()) continue;
        check_extension(output);
        const AtomicFile trial(output.path);  // creates a temporary file and removes it again
        for (const OutputFile* other = outputs.data(); other != &output; ++other) {
            if (other->path.empty() || real_path(other->path) != real_path(output.path)) continue;
            throw Error(ExitCode::usage, std::string(output.option) + " " + output.path +
                                             ": is the file of " + other->option + " too");
        }
    }
}

void check_split_spares(const OutputFile& output, const SceneDesc& scene) {
    std::string name = output.path;
    if (name.find(kPlaceholder) == std::string::npos)
        name = fs::path(name).replace_extension("." + std::string(kPlaceholder)).string() +
               fs::path(output.path).extension().string();
    const std::size_t at = name.find(kPlaceholder);
    const fs::path start = real_path(name.substr(0, at) + "x");
    const std::string before = start.string().substr(0, start.string().size() - 1);
    const std::string after = name.substr(at + kPlaceholder.size());
    for (const std::string& input : inputs_of(scene)) {
        const std::string real = input.empty() ? "" : real_path(input).string();
        if (real.size() < before.size() + after.size() || !real.starts_with(before) ||
            !real.ends_with(after))
            continue;
        throw Error(ExitCode::usage, std::string(output.option) + " " + output.path +
                                         ": a pass could replace '" + input +
                                         "', which the scene is read from; give another name");
    }
}

void check_outputs_spare(const std::vector<OutputFile>& outputs, const SceneDesc& scene) {
    const std::vector<std::string> inputs = inputs_of(scene);
    for (const OutputFile& output : outputs) {
        if (output.path.empty()) continue;
        for (const std::string& input : inputs) {
            if (input.empty() || real_path(input) != real_path(output.path)) continue;
            throw Error(
                ExitCode::usage,
                std::string(output.option) + " " + output.path +
                    ": would replace a file that the scene is read from; give another name");
        }
    }
}

}  // namespace tessera
