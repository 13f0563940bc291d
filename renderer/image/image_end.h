#pragma once
// Whether a file reaches the end of its picture. JPEG decoders fill what is missing with grey and
// say nothing; the PNG reader in use loses memory when its data ends early.

#include <string>

#include "renderer/image/image_format.h"

namespace tessera {

/// False if the file at path, known to be of this format, is cut short. Formats whose readers tell
/// by themselves (TIFF, OpenEXR, HDR) are always true.
bool reaches_end(const std::string& path, ImageFormat format);

}  // namespace tessera
