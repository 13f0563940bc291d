#pragma once
// Any renderer's EXR against the rules of exr_rules.h.

#include <string>

#include "renderer/image/check/exr_rules.h"

namespace tessera {

/// Findings, the worst first. A file that cannot be opened or is damaged is a finding, not an
/// exception; nothing of a hostile file's size is believed before it is checked.
ExrFindings check_exr(const std::string& path);

}  // namespace tessera
