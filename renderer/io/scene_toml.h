#pragma once
// The scene file: a document's tables to a SceneDesc.

#include <string>

#include "renderer/api/scene_desc.h"
#include "renderer/io/assets.h"
#include "renderer/io/params.h"

namespace tessera {

/// The tables a scene may have; every other list of keys hangs below.
const KeyList& scene_keys();

/// Reads document (a scene file, or what stands for a bare OBJ) into a scene. folder: what names
/// without a file of their own are relative to. Reports through problems, and throws what they
/// hold.
SceneDesc read_scene(Value document, const std::string& path, const std::string& folder,
                     const AssetRules& assets, Problems& problems);

/// Whether anything in the scene gives light: a light, an environment, or a material in use that
/// emits. textured: emission by a texture counts (it may be a display's few bright dots).
bool has_emitter(const SceneDesc& scene, bool textured);

}  // namespace tessera
