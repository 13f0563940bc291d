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
    ExrLayout layout = ExrLayout::single;
    ExrCompression compression = ExrCompression::zip;
    float dwa_level = 45;
};

/// What became of the values on the way to the file.
struct WriteReport {
    std::uint64_t non_finite = 0;    // replaced by 0
    std::uint64_t clamped = 0;       // beyond +-65504 in a half channel
    std::uint64_t bytes = 0;         // of all files
    std::vector<std::string> files;  // their names, beauty first
};

/// Writes layered EXRs beside their targets, reads them back, renames them over the targets. A kill
/// at any moment leaves an old file or a new one; of a split picture all files are written and
/// checked before the first is renamed. Layers of LayerKind::data are float and without loss
/// whatever the options; in a single part, which has one codec, dwaa and dwab are refused beside
/// them. Throws Error(ExitCode::output), Error(ExitCode::usage) for options that exclude each
/// other.
WriteReport write_exr(const LayeredImage& image, const std::string& path,
                      const WriteOptions& options = {});

/// The files that write_exr makes, without making them.
std::vector<std::string> exr_files(const LayeredImage& image, const std::string& path,
                                   const WriteOptions& options);

/// The same picture over another window: what lies outside is left out, what is missing is 0 (Z:
/// 1e10).
LayeredImage reframe(const LayeredImage& image, const PixelWindow& window);

/// Writes the beauty (root R,G,B,A) as .png or .jpg through a display view ("" = the config's
/// default). Throws Error(ExitCode::output).
void write_preview(const LayeredImage& image, const std::string& path,
                   const std::string& view = "");

}  // namespace tessera
