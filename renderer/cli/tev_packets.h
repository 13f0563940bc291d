#pragma once
// Packets of the tev viewer's protocol over TCP (github.com/Tom94/tev): u32 size of the whole, u8
// type, fields; little-endian, strings end in NUL, nothing is padded.

#include <string>
#include <vector>

#include "renderer/image/live_picture.h"

namespace tessera {

/// CreateImage: a black picture under this name.
std::string tev_create(const std::string& name, int width, int height,
                       const std::vector<std::string>& channels);

/// UpdateImageV2: pixels of a rectangle, planar; piece.window counts from the picture's corner.
std::string tev_update(const std::string& name, const std::vector<std::string>& channels,
                       const LivePicture::Piece& piece);

}  // namespace tessera
