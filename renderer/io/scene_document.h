#pragma once
// One scene as one tree: the file, what it includes, and what --set puts over both.

#include <string>
#include <vector>

#include "renderer/io/assets.h"
#include "renderer/io/params.h"

namespace tessera {

/// Reads path and everything it includes. An including file wins over what it includes, key by key;
/// [[tables]] are joined, included ones first. Appends every file read to files. Throws
/// Error(scene).
Value read_document(const std::string& path, const AssetRules& assets,
                    std::vector<std::string>& files);

/// Puts "camera.fov_deg=35" over the document. keys: the tables of a scene. A [[table]] is
/// addressed by its name or its number: light.key.radiance, light[0].radiance; a name with dots in
/// quotes. A material that only an OBJ's library defines is changed, not replaced. Throws
/// Error(usage) for what is no assignment, and reports what it names but is not there.
void apply_set(Value& document, const std::string& assignment, const KeyList& keys,
               Problems& problems);

/// The folder that names written at loc are relative to; `root` for what no file says.
std::string folder_of(const SourceLoc& loc, const std::string& root);

}  // namespace tessera
