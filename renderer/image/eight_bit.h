#pragma once
// Pictures for the eye: PNG and JPEG.

#include <span>
#include <string>

namespace tessera {

/// Throws Error(usage) unless the name ends in .png, .jpg or .jpeg.
void check_eight_bit(const std::string& path);

/// Interleaved sRGB. Whole or not at all. Throws Error(output); Error(usage) as above.
void write_eight_bit(std::span<const unsigned char> rgb, int width, int height,
                     const std::string& path);

}  // namespace tessera
