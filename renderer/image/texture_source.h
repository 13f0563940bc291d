#pragma once
// The files behind textures: what each one is, which of them memory takes, and how they are read.
// Private to the texture store.

#include <exception>
#include <string>
#include <vector>

#include "renderer/image/pyramid.h"
#include "renderer/image/texture.h"

namespace tessera {

/// A file in one colour space, read once however many textures use it.
struct TextureSource {
    std::string file;
    std::string color_space;  // "" until survey() decides by the kind of file
    SourceLoc loc;
    std::vector<std::string> users;  // of all its requests

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
    bool no_tx = false;                // none can be made

    Pyramid pyramid;
    bool in_core = true;
    int skip = 0;          // finest levels that memory has no room for
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

/// Whether the tile cache reads the file a piece at a time.
inline bool fits_cache(const TextureSource& s) { return s.cacheable && s.tiled; }
/// And the levels in it are means of light.
inline bool reads_well(const TextureSource& s) { return fits_cache(s) && !s.srgb; }

/// Decides in_core and skip for all, by sizes and order alone, and tells in `bytes` what a pyramid
/// will be. Everything is in memory if it fits, but for what the cache reads well and is over
/// options.in_core_bytes. Else what cannot be in the cache comes before all others, the largest
/// halved until it fits; then what is up to options.in_core_bytes, the smallest first. Pictures in
/// memory get half of it if any may be in the cache. Returns what is left for the cache, in bytes;
/// 0: nothing is in it.
std::int64_t place_sources(std::vector<TextureSource>& sources, const TextureOptions& options);

/// Builds the pyramid, without its first `skip` levels. Never throws: as survey().
void load_pixels(TextureSource& s, const ColorSpaces& colors, const ByteTables& tables) noexcept;

void become_magenta(TextureSource& s, const ByteTables& tables, const Error& why);

}  // namespace tessera
