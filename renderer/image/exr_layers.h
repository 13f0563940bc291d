#pragma once
// Layered EXR files read back: what resume, merge and compare start from. Writing is in
// api/image.h.

#include <string>

#include "renderer/api/image.h"
#include "renderer/image/image_io.h"

namespace tessera {

/// Reads a flat EXR of one part or of several with one data window. Channels "layer.C" become
/// layers, the root first; bare channels of later parts are layers by the part's name. Half
/// channels are LayerKind::color, float ones LayerKind::data, so that writing again loses nothing.
/// Root channels other than R, G, B, A are a layer of their own. Of the first part's header int,
/// float and string attributes that are not part of the format become metadata; working_space is
/// told from the chromaticities ("" = unknown ones). Throws Error(ExitCode::scene): missing, no
/// EXR, deep, truncated, over the limits.
LayeredImage read_exr(const std::string& path, const ImageLimits& limits = {});

}  // namespace tessera
