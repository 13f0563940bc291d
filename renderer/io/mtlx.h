#pragma once
// MaterialX documents as materials of a scene; docs/materialx.md says what is read.

#include "renderer/io/scene_reader.h"

namespace tessera {

/// Reads the documents that `materialx` of a scene names, in their order, into
/// reader.materialx. What is no part of them is reported with its place.
void read_materialx(const Value& document, SceneReader& reader);

/// Puts them into the scene, in place of those of the same name that came with meshes.
void place_materialx(SceneReader& reader);

}  // namespace tessera
