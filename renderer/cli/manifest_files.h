#pragma once
// Cryptomatte manifests in files of their own, beside the picture.

#include <string>
#include <utility>
#include <vector>

#include "renderer/api/image.h"

namespace tessera {

struct ManifestFile {
    std::string path, text;
};

/// Takes the manifests out of the metadata and leaves there the names of files beside `output`:
/// shot.exr has shot.CryptoObject.json and so on.
std::vector<ManifestFile> move_manifests(
    std::vector<std::pair<std::string, MetadataValue>>& metadata, const std::string& output);

/// Each whole or not at all. Throws Error(output).
void write_manifests(const std::vector<ManifestFile>& files);

}  // namespace tessera
