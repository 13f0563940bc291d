#include "renderer/cli/manifest_files.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "renderer/image/atomic_file.h"

namespace tessera {
namespace {

constexpr std::string_view kPrefix = "cryptomatte/", kManifest = "/manifest";
constexpr std::string_view kPlaceholder = "<aov>";

// Beside the file that it belongs to.
std::filesystem::path manifest_path(std::string output, const std::string& type) {
    const std::size_t at = output.find(kPlaceholder);
    if (at != std::string::npos) output.replace(at, kPlaceholder.size(), type);
    return std::filesystem::path(output).replace_extension(
        at == std::string::npos ? "." + type + ".json" : ".json");
}

}  // namespace

std::vector<ManifestFile> move_manifests(
    std::vector<std::pair<std::string, MetadataValue>>& metadata, const std::string& output) {
    std::vector<ManifestFile> files;
    for (auto& [name, value] : metadata) {
        if (!name.starts_with(kPrefix) || !name.ends_with(kManifest)) continue;
        const std::string key = name.substr(0, name.size() - kManifest.size());
        const auto type = std::find_if(metadata.begin(), metadata.end(), [&](const auto& other) {
            return other.first == key + "/name";
        });
        if (type == metadata.end()) continue;
        const std::filesystem::path path =
            manifest_path(output, std::get<std::string>(type->second));
        files.push_back({path.string(), std::move(std::get<std::string>(value))});
        name = key + "/manif_file";
        value = path.filename().string();
    }
    return files;
}

void write_manifests(const std::vector<ManifestFile>& files) {
    for (const ManifestFile& f : files) {
        AtomicFile file(f.path);
        file.write(f.text.data(), f.text.size());
        file.finish();
        file.commit();
    }
}

}  // namespace tessera
