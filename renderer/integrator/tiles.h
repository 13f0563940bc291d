#pragma once
// The frame cut into tiles, in the order in which they are handed out.

#include <vector>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// Tiles aligned to multiples of `size` in the frame, cut to the window, along a Hilbert curve:
/// neighbours in time are neighbours in the picture. Hilbert 1891; Warren, "Hacker's Delight", 2nd
/// ed., section 16.
std::vector<PixelWindow> make_tiles(const PixelWindow& window, int size);

}  // namespace tessera
