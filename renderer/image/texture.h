#pragma once
// Filtered texture look-ups. Images live in memory as mip pyramids (8-bit with a decode table,
// 16-bit, or half floats). Those that a limit leaves no room for go through OpenImageIO's tile
// cache if it can read them a piece at a time, or lose their finest levels; large tiled ones are
// always there. One interface: the caller does not see which.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/api/scene_desc.h"

namespace tessera {

class ColorSpaces;
class Workers;

/// What the shading system reads a texture as; decides the default colour space: raw for data; for
/// colour sRGB in integer files and lin_rec709 in float ones (.exr, .hdr).
enum class TextureUse : std::uint8_t { color, data };

struct TextureRequest {
    const TextureDesc* desc = nullptr;
    TextureUse use = TextureUse::color;
    std::vector<std::string> users = {};  // whom to name when the file cannot be read
};

struct TextureOptions {
    std::int64_t memory_bytes = kTextureMemory;  // pyramids and tile cache together
    bool auto_tx = false;   // what the tile cache reads badly is first made into a .tx
    std::string tx_folder;  // "": default_tx_folder()
    /// More than this is not read as a whole where the tile cache reads it as well.
    std::int64_t in_core_bytes = std::int64_t(64) << 20;
};

/// What textures hold and have read.
struct TextureCounts {
    int in_core = 0, cached = 0;    // files
    std::int64_t memory_bytes = 0;  // now
    std::int64_t bytes_read = 0;    // by the tile cache, decoded
    std::int64_t failures = 0;      // look-ups that met a tile which cannot be read: magenta
};

/// RGBA; channels a file lacks: grey is spread over RGB, alpha is 1.
using Texel = std::array<float, 4>;

class TextureStore {
public:
    /// Loads, in parallel if workers are given; results never depend on it. An unreadable file is
    /// reported once through problems.warn and becomes a magenta 1x1; NaN and infinite texels
    /// become 0 and are counted in the warning; an unknown colour space is a problems.error.
    /// Which files stay in memory is decided by their sizes and order: place_sources().
    /// `colors` must outlive the store.
    TextureStore(const std::vector<TextureRequest>& requests, const ColorSpaces& colors,
                 Problems& problems, Workers* workers = nullptr,
                 const TextureOptions& options = {});
    ~TextureStore();
    TextureStore(const TextureStore&) = delete;
    TextureStore& operator=(const TextureStore&) = delete;

    /// Value at (u, v), v upward (v = 0 is the bottom row), after the texture's placement, wrap,
    /// gain and bias (the last two on RGB only; Wrap::black gives 0 outside, in alpha too if the
    /// file has one). width: footprint in uv units (the larger axis of the pixel's cone), 0 = the
    /// finest level; the texture's filter. seed: what the stochastic filter draws by, with (u, v).
    /// Linear working-space colour for TextureUse::color. Finite for any input (non-finite uv read
    /// as 0). Thread-safe. Of a set of tiles: magenta where there is none.
    Texel sample(int texture, float u, float v, float width, std::uint32_t seed = 0) const noexcept;

    int size() const noexcept;
    /// Mean over the image, RGBA, with gain and bias (for light importance and folding). An
    /// estimate from coarse levels for images in the tile cache that are no .tx of ours.
    Texel mean(int texture) const noexcept;
    /// True if every texel of channel c (0..3) equals 1: an alpha that cuts nothing out. False if
    /// not known (channels of the tile cache).
    bool channel_is_one(int texture, int c) const noexcept;
    bool has_alpha(int texture) const noexcept;
    /// A file that could not be read: magenta.
    bool is_missing(int texture) const noexcept;
    std::int64_t memory_bytes() const noexcept;
    TextureCounts counts() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
