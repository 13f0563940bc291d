#pragma once
// A film on disk: checkpoints, and parts of pictures to be merged.

#include <cstdint>
#include <span>
#include <string>

#include "renderer/film/film.h"
#include "renderer/film/film_header.h"

namespace tessera {

inline constexpr const char* kFilmExtension = ".tsf";
/// Whether a path ends so.
bool names_film_file(const std::string& path);

/// What a film's passes of names counted, in their order: what arrays() leaves out.
std::vector<IdCoverageState> coverage_states(Film& film);

/// Whole or not at all; returns the size. Throws Error(output).
std::uint64_t write_film_file(const std::string& path, const FilmHeader& header,
                              std::span<const Film::Array> arrays,
                              std::span<const IdCoverageState> coverage);
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
