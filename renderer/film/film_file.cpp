#include "renderer/film/film_file.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <new>
#include <optional>

#include "renderer/image/array_file.h"

namespace tessera {
namespace {

bool counts_names(const Pass& p) {
    return p.source == PassSource::crypto_object || p.source == PassSource::crypto_material ||
           p.source == PassSource::crypto_asset;
}

// The arrays of a state: visit(name, vector).
template <class State, class Visit>
void each_array(State& s, const Visit& visit) {
    visit(".sizes", s.sizes), visit(".keys", s.keys), visit(".counts", s.counts);
    visit(".dropped_at", s.dropped_at), visit(".dropped", s.dropped);
}

template <class State, class Visit>
void each_deep_array(State& s, const Visit& visit) {
    visit("deep_sizes", s.sizes), visit("deep_levels", s.levels), visit("deep_keys", s.keys);
    visit("deep_counts", s.counts), visit("deep_depths", s.depths), visit("deep_sums", s.sums);
}

// Names of a film's arrays and their sizes; what states take only the film knows.
struct Expected {
    std::string name;
    std::optional<std::uint64_t> bytes;
    std::size_t unit = 1;
};

std::vector<Expected> expected_arrays(const FilmHeader& h) {
    std::vector<Expected> out;
    for (const Film::ArraySize& a : Film::array_sizes(h.window, h.passes, h.extras))
        out.push_back({a.name, a.bytes});
    for (const Pass& p : h.passes) {
        if (!counts_names(p)) continue;
        IdCoverageState none;
        each_array(none, [&](const char* name, const auto& v) {
            out.push_back({p.name + name, std::nullopt, sizeof v[0]});
        });
    }
    if (h.extras.deep) {
        DeepPixelsState none;
        each_deep_array(none, [&](const char* name, const auto& v) {
            out.push_back({name, std::nullopt, sizeof v[0]});
        });
    }
    return out;
}

// Before a film is made, which takes as much memory as the header likes.
void check_arrays(const ArrayFile& file, const FilmHeader& h) {
    const std::vector<Expected> wanted = expected_arrays(h);
    const std::vector<ArrayFile::Entry>& there = file.arrays();
    if (there.size() != wanted.size())
        file.fail("is damaged: " + std::to_string(there.size()) + " arrays, its passes make " +
                  std::to_string(wanted.size()));
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const bool fits = wanted[i].bytes ? there[i].bytes == *wanted[i].bytes
                                          : there[i].bytes % wanted[i].unit == 0;
        if (there[i].name != wanted[i].name || !fits)
            file.fail("is damaged: array '" + there[i].name + "' of " +
                      std::to_string(there[i].bytes) + " bytes does not belong to its passes");
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

FilmStates states_of(Film& film) {
    FilmStates out;
    for (std::size_t p = 0; p < film.passes().size(); ++p)
        if (const IdCoverage* c = film.coverage(p)) out.coverage.push_back(c->state());
    if (film.deep()) out.deep = film.deep()->state();
    return out;
}

std::uint64_t write_film_file(const std::string& path, const FilmHeader& header,
                              std::span<const Film::Array> arrays, const FilmStates& states) {
    std::vector<NamedBytes> named;
    for (const Film::Array& a : arrays) named.push_back({a.name, a.bytes});
    auto state = states.coverage.begin();
    for (const Pass& p : header.passes) {
        if (!counts_names(p)) continue;
        each_array(*state++, [&](const char* name, const auto& v) {
            named.push_back({p.name + name, std::as_bytes(std::span(v))});
        });
    }
    if (header.extras.deep) {
        each_deep_array(*states.deep, [&](const char* name, const auto& v) {
            named.push_back({name, std::as_bytes(std::span(v))});
        });
    }
    return write_array_file(path, to_json(header), named);
}

std::uint64_t write_film_file(const std::string& path, const FilmHeader& header, Film& film) {
    return write_film_file(path, header, film.arrays(), states_of(film));
}

FilmHeader read_film_header(const std::string& path) { return header_of(ArrayFile(path)); }

FilmFile read_film_file(const std::string& path) {
    ArrayFile file(path);
    FilmHeader header = header_of(file);
    Film film(header.window, header.passes, header.extras);
    std::vector<std::span<std::byte>> into;
    for (const Film::Array& a : film.arrays()) into.push_back(a.bytes);
    const auto names = std::count_if(header.passes.begin(), header.passes.end(), counts_names);
    std::vector<IdCoverageState> coverage(static_cast<std::size_t>(names));
    const auto room = [&](const char*, auto& v) {
        v.resize(file.arrays()[into.size()].bytes / sizeof v[0]);
        into.push_back(std::as_writable_bytes(std::span(v)));
    };
    for (IdCoverageState& state : coverage) each_array(state, room);
    DeepPixelsState deep;
    if (header.extras.deep) each_deep_array(deep, room);
    file.read(into);
    auto state = coverage.begin();
    for (std::size_t p = 0; p < header.passes.size(); ++p) {
        if (!counts_names(header.passes[p])) continue;
        const auto keys = static_cast<std::uint32_t>(header.ids[p].size());
        std::optional<IdCoverage> read = IdCoverage::from(*state++, keys);
        if (!read || read->pixels() != film.coverage(p)->pixels())
            file.fail("is damaged: its counts of names contradict each other");
        *film.coverage(p) = std::move(*read);
    }
    if (header.extras.deep && !film.take_deep(deep))
        file.fail("is damaged: its depths contradict each other");
    if (!film.counts_make_sense())
        file.fail("is damaged: its pixels have replicates of impossible length");
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
