#pragma once
// A fingerprint of a description: equal scenes have equal ones, whatever the file was called.

#include <string>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// 16 hex digits over geometry, materials, lights, camera, film, what is in the images, and
/// settings that change pixels (not spp or crop).
std::string scene_hash(const SceneDesc& desc);

}  // namespace tessera
