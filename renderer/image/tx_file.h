#pragma once
// Pyramids on disk: tiled, mip-mapped TIFFs (.tx) that the tile cache reads a piece at a time. A
// look-up through the cache then gives the bits of one in memory.

#include <array>
#include <optional>
#include <string>

#include "renderer/image/pyramid.h"

namespace tessera {

/// $XDG_CACHE_HOME/tessera/tx, or ~/.cache/tessera/tx; "" if neither variable is set.
std::string default_tx_folder();

/// folder/NAME.HASH.tx, where the hash is of the file's path, size and time, and of what the colour
/// space does to colours. "" if the file cannot be looked at.
std::string tx_path(const std::string& folder, const std::string& file,
                    const std::string& color_space, const ColorSpaces& colors);

/// What is known of all texels without reading them; a .tx carries it as its ImageDescription.
struct TexelSummary {
    Texel mean{0, 0, 0, 1};
    std::array<bool, 4> is_one{false, false, false, true};
};
std::string describe_texels(const TexelSummary& summary);
std::optional<TexelSummary> parse_texels(const std::string& text);

/// Whole or not at all; makes the folder. Throws Error(ExitCode::output).
void write_tx(const Pyramid& pyramid, const std::string& path);

}  // namespace tessera
