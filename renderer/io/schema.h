#pragma once
// The scene file's JSON Schema, for editors that complete and check TOML.

#include <string>

namespace tessera {

/// JSON Schema (draft 7) made from the reader's own rows; docs/scene.schema.json holds this text.
std::string scene_schema_json();

}  // namespace tessera
