#pragma once
// Pixels in memory: one layer of a picture, and its way to disk.

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// How a channel is stored: colour may be half, data must be float.
enum class LayerKind : std::uint8_t { color, data };

/// Named channels over a window, row-major from the top, channels interleaved.
struct Layer {
    std::string name;                   // "" = root of the file (beauty, Z)
    std::vector<std::string> channels;  // {"R","G","B","A"}, {"X","Y","Z"}, {"Z"} ...
    LayerKind kind = LayerKind::color;
    std::vector<float> pixels;  // window.width * window.height * channels.size()
};

using MetadataValue = std::variant<int, float, std::string>;

/// A layered picture: display is the full frame, window the pixels that are there.
struct LayeredImage {
    int width = 0;  // display window
    int height = 0;
    PixelWindow window;
    std::string working_space = "lin_rec709";
    std::vector<Layer> layers;
    std::vector<std::pair<std::string, MetadataValue>> metadata;  // "tessera/spp" -> 64
};

struct WriteOptions {
    bool all_float = false;
    int threads = 0;  // for compression; 0 = as many as the process may use
};

/// What became of the values on the way to half floats.
struct WriteReport {
    std::uint64_t non_finite = 0;  // replaced by 0
    std::uint64_t clamped = 0;     // beyond +-65504 in a half channel
    std::uint64_t bytes = 0;       // size of the file
};

/// Writes one single-part layered EXR beside `path`, reads it back, renames it over `path`.
/// A kill at any moment leaves the old file or the new one. Throws Error(ExitCode::output).
WriteReport write_exr(const LayeredImage& image, const std::string& path,
                      const WriteOptions& options = {});

/// Writes the beauty (root R,G,B,A) as .png or .jpg through a display view ("" = the config's
/// default). Throws Error(ExitCode::output).
void write_preview(const LayeredImage& image, const std::string& path,
                   const std::string& view = "");

}  // namespace tessera
