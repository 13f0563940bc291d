#pragma once
// Finds out before the render whether its result can be written.

#include <string>

namespace tessera {

/// Throws Error(output) if `path` cannot be created: its folder is missing or not writable, or it is a folder.
void check_output(const std::string& path, const char* option);

}  // namespace tessera
