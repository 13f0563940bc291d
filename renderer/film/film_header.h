#pragma once
// What a film file says of its film: enough to write the picture without the scene, and to tell
// whether two films are of one picture.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/film/film_extras.h"
#include "renderer/film/pass.h"

namespace tessera {

struct FilmHeader {
    std::string version;  // of Tessera
    std::string isa;      // of Embree
    std::string scene;    // as it was named
    std::string scene_hash;
    std::string working_space;
    int width = 0, height = 0;  // the full frame
    PixelWindow window;
    std::uint64_t seed = 0;
    Passes passes;
    FilmExtras extras;
    std::vector<std::vector<std::uint32_t>> ids;  // of passes that count names: theirs, by key
    int first_sample = 0;                         // index
    std::uint32_t least = 0, most = 0;            // samples of a pixel
    double seconds = 0;                           // of rendering, all parts together
    int parts = 1;                                // that were merged
    std::vector<std::pair<std::string, MetadataValue>> metadata;
};

std::string to_json(const FilmHeader& header);
/// Throws std::runtime_error with the reason.
FilmHeader film_header_from(const std::string& json);

/// The first thing in which two films are not of one picture, and how it is in each. Window,
/// samples and seconds may differ.
struct FilmDifference {
    std::string what, a, b;
};
std::optional<FilmDifference> difference(const FilmHeader& a, const FilmHeader& b);

/// "x0,y0,x1,y1", as --crop takes it.
std::string to_string(const PixelWindow& window);

}  // namespace tessera
