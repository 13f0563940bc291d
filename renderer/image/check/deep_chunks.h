#pragma once
// Whether the chunks of a deep part are there, and of sizes that one may allocate for.

#include <string>

#include "renderer/image/check/exr_raw.h"

namespace tessera {

/// "" or what is wrong with the chunks of the first part, deep scanlines.
std::string deep_damage(const std::string& path, const RawExr& file);

}  // namespace tessera
