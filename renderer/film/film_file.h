#pragma once
// A film on disk: checkpoints, and parts of pictures to be merged.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/film/film_header.h"

namespace tessera {

inline constexpr const char* kFilmExtension = ".tsf";
/// Whether a path ends so.
bool names_film_file(const std::string& path);

/// What arrays() leaves out.
struct FilmStates {
    std::vector<IdCoverageState> coverage;  // of the passes of names, in their order
    std::optional<DeepPixelsState> deep;
    bool operator==(const FilmStates&) const = default;
};
FilmStates states_of(Film& film);

/// Whole or not at all; returns the size. Throws Error(output).
std::uint64_t write_film_file(const std::string& path, const FilmHeader& header,
                              std::span<const Film::Array> arrays, const FilmStates& states);
std::uint64_t write_film_file(const std::string& path, const FilmHeader& header, Film& film);

/// Throws Error(scene): no such file, foreign, cut short, damaged, of another format.
FilmHeader read_film_header(const std::string& path);

struct FilmFile {
    FilmHeader header;
    Film film;
};
FilmFile read_film_file(const std::string& path);

/// Fewest and most samples of the film's pixels.
struct SampleCounts {
    std::uint32_t least = 0, most = 0;
};
SampleCounts sample_range(const Film& film);

}  // namespace tessera
