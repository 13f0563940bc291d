#pragma once
// What made a picture, for the header of its file.

#include <string>

#include "renderer/api/render.h"

namespace tessera {

/// Adds "tessera/..." attributes, and the standard capDate unless the format says deterministic:
/// then nothing that another run of the same scene could differ in.
void describe_picture(LayeredImage& image, const std::string& scene_hash, const Statistics& stats,
                      const std::string& command, const OutputDesc& format);

}  // namespace tessera
