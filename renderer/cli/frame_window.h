#pragma once
// Which pixels are rendered and which are written, where they are not the frame.

#include <optional>

#include "renderer/api/scene_desc.h"

namespace tessera {

struct FrameWindow {
    std::optional<PixelWindow> render;  // for FilmDesc::crop
    PixelWindow write;
};

/// A crop goes before overscan. Tiles start at multiples of their size from the frame's corner, so
/// what is rendered beyond the left and top edges is whole tiles, and cut afterwards. Throws
/// Error(usage) where the picture has nothing beyond its edges.
FrameWindow frame_window(const SceneDesc& scene, int tile);

}  // namespace tessera
