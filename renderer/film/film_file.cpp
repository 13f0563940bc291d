#include "renderer/film/film_file.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <new>

#include "renderer/image/array_file.h"

namespace tessera {
namespace {

// Before a film is made, which takes as much memory as the header likes.
void check_arrays(const ArrayFile& file, const FilmHeader& h) {
    const std::vector<Film::ArraySize> wanted = Film::array_sizes(h.window, h.passes);
    const std::vector<ArrayFile::Entry>& there = file.arrays();
    if (there.size() != wanted.size())
        file.fail("is damaged: " + std::to_string(there.size()) + " arrays, its passes make " +
                  std::to_string(wanted.size()));
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (there[i].name != wanted[i].name || there[i].bytes != wanted[i].bytes)
            file.fail("is damaged: array '" + there[i].name + "' of " +
                      std::to_string(there[i].bytes) + " bytes, expected '" + wanted[i].name +
                      "' of " + std::to_string(wanted[i].bytes));
    }
}

FilmHeader header_of(const ArrayFile& file) {
    try {
        FilmHeader header = film_header_from(file.header());
        check_arrays(file, header);
        return header;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        file.fail(std::string("is damaged: its header: ") + e.what());
    }
}

}  // namespace

bool names_film_file(const std::string& path) {
    const std::string end = kFilmExtension;
    return path.size() > end.size() &&
           std::equal(end.rbegin(), end.rend(), path.rbegin(), [](char a, char b) {
               return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
           });
}

std::uint64_t write_film_file(const std::string& path, const FilmHeader& header,
                              std::span<const Film::Array> arrays) {
    std::vector<NamedBytes> named;
    for (const Film::Array& a : arrays) named.push_back({a.name, a.bytes});
    return write_array_file(path, to_json(header), named);
}

FilmHeader read_film_header(const std::string& path) { return header_of(ArrayFile(path)); }

FilmFile read_film_file(const std::string& path) {
    ArrayFile file(path);
    FilmHeader header = header_of(file);
    Film film(header.window, header.passes);
    std::vector<std::span<std::byte>> into;
    for (const Film::Array& a : film.arrays()) into.push_back(a.bytes);
    file.read(into);
    const SampleCounts counts = sample_range(film);
    if (counts.least != header.least || counts.most != header.most)
        file.fail("is damaged: its pixels have not the samples that its header says");
    return {std::move(header), std::move(film)};
}

SampleCounts sample_range(const Film& film) {
    const PixelWindow& w = film.window();
    SampleCounts c{std::numeric_limits<std::uint32_t>::max(), 0};
    for (int y = w.y0; y < w.y1; ++y) {
        for (int x = w.x0; x < w.x1; ++x) {
            const std::uint32_t n = film.samples(x, y);
            c.least = std::min(c.least, n), c.most = std::max(c.most, n);
        }
    }
    return c;
}

}  // namespace tessera
