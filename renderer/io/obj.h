#pragma once
// OBJ files: a normaliser of ours, tinyobjloader in double precision, checks of ours.

#include <set>
#include <string>

#include "renderer/api/scene_desc.h"
#include "renderer/io/assets.h"

namespace tessera {

struct ObjOptions {
    SourceLoc from;  // where the scene names this file, for errors about the file itself
    std::set<std::string> defined = {};  // materials that the scene defines, so no library has to
};

/// Reads path into scene: appends one mesh, its materials (and a default one when needed) and
/// textures, and every file read to scene.files. Returns the index of the mesh. Throws Error for a
/// file that gives no face at all; faces that cannot be right are dropped with a located warning
/// (counted past the first few of a kind).
int load_obj(const std::string& path, const AssetRules& assets, SceneDesc& scene,
             Problems& problems, const ObjOptions& options = {});

}  // namespace tessera
