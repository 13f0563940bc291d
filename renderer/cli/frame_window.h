#pragma once
// Which pixels are rendered, where they are not the frame.

#include <optional>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// For FilmDesc::crop: the crop that is asked for, else the frame with its overscan. Throws
/// Error(usage) where the picture has nothing beyond its edges.
std::optional<PixelWindow> frame_window(const SceneDesc& scene);

}  // namespace tessera
