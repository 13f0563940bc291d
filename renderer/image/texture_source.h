#pragma once
// The files behind textures: what each one is, which of them memory takes, and how they are read.
// Private to the texture store.

#include <exception>
#include <string>
#include <vector>

#include "renderer/image/pyramid.h"

namespace tessera {

/// A file in one colour space, read once however many textures use it.
struct TextureSource {
    std::string file;
    std::string color_space;  // "" until survey() decides by the kind of file
    SourceLoc loc;

    // Told by the header.
    int width = 1, height = 1;
    int channels = 3;  // that are kept
    bool alpha = false;
    bool srgb = false;
    TexelType type = TexelType::byte;  // as a pyramid
    std::int64_t bytes = 0;            // as a pyramid
    std::int64_t finest_bytes = 0;     // its finest level
    bool tiled = false;                // and mip-mapped
    bool cacheable = false;            // as it is: see survey()

    Pyramid pyramid;
    bool in_core = true;
    bool magenta = false;  // it could not be read
    int tile = -1;         // in the tile cache instead

    std::vector<std::string> damages, warnings, notes;
    std::string error;  // the colour space is unknown: the user's mistake, not the file's
    std::exception_ptr fatal;
};

std::string named(const TextureSource& s);

/// Opens the file and fills in what its header says. The tile cache applies the sRGB curve or
/// nothing, and reads the first channels: other pictures are not cacheable as they are. A file that
/// cannot be read becomes magenta, told in damages or warnings. Never throws: see error and fatal.
void survey(TextureSource& s, const ColorSpaces& colors, const ByteTables& tables) noexcept;

/// Decides in_core for all, by sizes and order alone: everything if it fits; else pictures up to
/// kInCoreBytes, the smallest first, in half of the memory. Those that are not cacheable come
/// before all others, whatever the limit, unless any can be made so. Returns what is left for the
/// cache, in bytes.
std::int64_t place_sources(std::vector<TextureSource>& sources, std::int64_t memory_bytes,
                           bool any_cacheable);

/// Builds the pyramid. Never throws: as survey().
void load_pixels(TextureSource& s, const ColorSpaces& colors, const ByteTables& tables) noexcept;

void become_magenta(TextureSource& s, const ByteTables& tables, const Error& why);

}  // namespace tessera
