#pragma once
// [environment] and [sky]: light from all around. Private to the scene reader.

#include "renderer/io/scene_reader.h"

namespace tessera {

void read_environment(const Value& table, SceneReader& reader);
void read_sky(const Value& table, SceneReader& reader);

}  // namespace tessera
