#pragma once
// [environment] and [sky], and what shows all directions beside them. Private to the scene reader.

#include <optional>

#include "renderer/io/params.h"
#include "renderer/io/scene_reader.h"

namespace tessera {

void read_environment(const Value& table, SceneReader& reader);
void read_sky(const Value& table, SceneReader& reader);

/// A material's reflection_map; nothing after an error, which is reported.
std::optional<ReflectionMapDesc> read_reflection_map(const Value& value, SceneReader& reader,
                                                     const ReadContext& at);
const KeySet<ReflectionMapDesc>& reflection_map_keys();

}  // namespace tessera
