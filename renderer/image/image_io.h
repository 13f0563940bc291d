#pragma once
// Pictures from disk, whatever the format, as floats; checked before anything is allocated.

#include <cstdint>
#include <string>
#include <vector>

namespace tessera {

/// Row-major from the top, channels interleaved. Values as stored (8-bit scaled to 0..1), no colour
/// change.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;
};

/// What a file says of itself, read without its pixels.
struct ImageInfo {
    int width = 0;
    int height = 0;
    int channels = 0;
    int bits = 8;           // per channel
    bool is_float = false;  // half or float: linear data
    bool tiled = false;     // has tiles and mip levels: fit for the texture cache
};

struct ImageLimits {
    std::int64_t max_pixels = std::int64_t(1) << 30;
    std::int64_t max_bytes = std::int64_t(4) << 30;  // decoded
    int max_channels = 64;
};

/// Opens and checks (regular file, known format, sane size). Throws Error(ExitCode::scene) naming
/// the file. Formats: PNG, JPEG, TIFF (and .tx), OpenEXR, Radiance HDR; told by content, not by
/// name.
ImageInfo image_info(const std::string& path, const ImageLimits& limits = {});

/// Reads all of it. Throws Error(ExitCode::scene). A truncated or corrupt file is an error.
Image read_image(const std::string& path, const ImageLimits& limits = {});

}  // namespace tessera
