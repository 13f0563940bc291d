// Film files: what is written comes back, and nothing else is taken for one.
#include <doctest/doctest.h>
#include <xxhash.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>

#include "renderer/film/film_file.h"
#include "renderer/image/array_file.h"
#include "tests/support/random.h"
#include "tests/support/temp_folder.h"

using namespace tessera;

namespace {

const PixelWindow kWindow{-2, 3, 5, 7};

FilmHeader header_of(const std::vector<std::string>& passes) {
    FilmHeader h;
    h.version = "0.1.0";
    h.isa = "avx2";
    h.scene = "a \xff scene.toml";  // a name that is no UTF-8
    h.scene_hash = "0123456789abcdef";
    h.working_space = "acescg";
    h.width = 32, h.height = 16;
    h.window = kWindow;
    h.seed = 0xfedcba9876543210u;
    h.passes = choose_passes(passes, {"default", "key"}, {});
    for (const Pass& p : h.passes) {
        h.ids.emplace_back();
        if (p.name == "CryptoObject") h.ids.back() = {7, 0xffffffff, 3};
    }
    h.first_sample = 4;
    h.least = h.most = 3;
    h.seconds = 1.0 / 3;
    h.metadata = {{"whole", 3}, {"third", 1.0f / 3}, {"text", std::string("{\"a\":1}")}};
    return h;
}

// Three samples of every pixel, of everything.
Film film_of(const FilmHeader& h) {
    Film film(h.window, h.passes, h.extras);
    Random random(5);
    const auto any = [&] { return random.unit(); };
    PassSamples passes = film.pass_samples();
    for (std::uint32_t index = 4; index < 7; ++index) {
        for (int y = kWindow.y0; y < kWindow.y1; ++y) {
            for (int x = kWindow.x0; x < kWindow.x1; ++x) {
                passes.clear();
                FirstHit& f = passes.first[0];
                f.hit = any() < 0.8f;
                f.z = any(), f.p = {any(), any(), any()}, f.n = {any(), any(), any()};
                f.object = any() < 0.5f ? 1 : 3;
                for (Color& c : passes.light) c = {any(), any(), any()};
                film.add(x, y, index, {{any(), any(), any()}, f.hit ? 1.0f : 0.0f}, &passes, 0);
            }
        }
    }
    return film;
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write(const std::string& path, const std::string& bytes) { write_anew(path, bytes); }

// The sum made right again, so that what is behind it is tested.
std::string summed(std::string bytes) {
    const std::uint64_t sum = XXH3_64bits(bytes.data(), bytes.size() - 8);
    std::memcpy(bytes.data() + bytes.size() - 8, &sum, 8);
    return bytes;
}

// Why a file is refused; "" if it is not.
std::string refusal(const std::string& path) {
    try {
        read_film_file(path);
    } catch (const Error& e) {
        CHECK(e.code() == ExitCode::scene);
        CHECK(std::string(e.what()).starts_with(path + ": "));
        return e.what();
    }
    return "";
}

const std::vector<std::string> kSome{
    "Z", "P", "N", "CryptoObject", "variance", "key = C<RD>L", "shadow_matte"};

struct Written {
    TempFolder folder;
    std::string path = folder / "a.tsf";
    FilmHeader header = header_of(kSome);
    Film film = film_of(header);
    std::string bytes;
    Written() {
        const std::uint64_t size = write_film_file(path, header, film);
        bytes = bytes_of(path);
        REQUIRE(bytes.size() == size);
    }
};

}  // namespace

TEST_CASE("film file: every kind of pass comes back, bit for bit") {
    std::vector<std::string> all;
    for (const PassInfo& p : ready_passes()) all.emplace_back(p.name);
    all.emplace_back("light_groups");
    all.emplace_back("mine = C<RD>.*[LO]");
    TempFolder folder;
    const FilmHeader h = header_of(all);
    Film film = film_of(h);
    write_film_file(folder / "a.tsf", h, film);
    CHECK(folder.count() == 1);
    FilmFile read = read_film_file(folder / "a.tsf");
    CHECK(!difference(h, read.header));
    CHECK(read.header.window == h.window);
    CHECK(read.header.seed == h.seed);
    CHECK(read.header.seconds == h.seconds);
    CHECK(read.header.metadata == h.metadata);
    CHECK(read.header.first_sample == 4);
    CHECK(read.header.most == 3);
    const auto a = film.arrays(), b = read.film.arrays();
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        INFO(a[i].name);
        REQUIRE(a[i].bytes.size() == b[i].bytes.size());
        CHECK(std::memcmp(a[i].bytes.data(), b[i].bytes.data(), a[i].bytes.size()) == 0);
    }
    CHECK(states_of(film).coverage == states_of(read.film).coverage);
    CHECK(states_of(film).coverage.size() == 3);
}

TEST_CASE("film file: depths come back, and only those that go with the samples") {
    const TempFolder folder;
    FilmHeader h = header_of({"Z", "CryptoObject"});
    h.extras.deep = true;
    Film film = film_of(h);
    write_film_file(folder / "a.tsf", h, film);
    FilmFile read = read_film_file(folder / "a.tsf");
    CHECK(read.header.extras.deep);
    REQUIRE(states_of(film).deep);
    CHECK(states_of(film) == states_of(read.film));
    CHECK(states_of(film).deep->keys.size() > 50);

    const auto spoilt = [&](auto spoil) {
        FilmStates states = states_of(film);
        spoil(*states.deep);
        write_film_file(folder / "b.tsf", h, film.arrays(), states);
        return refusal(folder / "b.tsf");
    };
    CHECK(spoilt([](auto&) {}) == "");
    CHECK(spoilt([](auto& s) { ++s.counts[0]; }).find("depths") != std::string::npos);
    CHECK(spoilt([](auto& s) { s.sizes.push_back(0), s.levels.push_back(0); }).find("depths") !=
          std::string::npos);
    CHECK(spoilt([](auto& s) { s.sums.pop_back(); }).find("depths") != std::string::npos);
    CHECK(spoilt([](auto& s) { s = {}; }).find("depths") != std::string::npos);
}

TEST_CASE("film file: cut short anywhere it is refused, and says so") {
    Written w;
    for (std::size_t n = 0; n < w.bytes.size(); ++n) {
        // Every byte of header and tables, then a prime's steps.
        if (n > 4000 && n % 97 != 0 && n + 20 < w.bytes.size()) continue;
        write(w.path, w.bytes.substr(0, n));
        const std::string why = refusal(w.path);
        INFO(n, " ", why);
        CHECK(why.find(n < 8 ? "no Tessera film file" : "cut short") != std::string::npos);
    }
}

TEST_CASE("film file: a flipped bit anywhere is found") {
    Written w;
    for (std::size_t n = 0; n < w.bytes.size(); n += n < 4000 ? 1 : 97) {
        std::string bytes = w.bytes;
        bytes[n] = static_cast<char>(bytes[n] ^ (1 << (n % 8)));
        write(w.path, bytes);
        INFO(n);
        CHECK(refusal(w.path) != "");
    }
    write(w.path, w.bytes);
    CHECK(refusal(w.path) == "");
}

TEST_CASE("film file: sizes that a hostile header claims are not believed") {
    Written w;
    // The words of the head: format, arrays, bytes of the table, of the text; bytes of the file.
    for (std::size_t at = 8; at < 32; at += 4) {
        for (const std::uint32_t v : {0u, 1u, 0x7fffffffu, 0xffffffffu}) {
            std::string bytes = w.bytes;
            if (std::memcmp(bytes.data() + at, &v, 4) == 0) continue;
            std::memcpy(bytes.data() + at, &v, 4);
            write(w.path, summed(bytes));
            INFO(at, " ", v);
            CHECK(refusal(w.path) != "");
        }
    }
    // The first array's size.
    for (const std::uint64_t v : {std::uint64_t{0}, ~std::uint64_t{0}, std::uint64_t{1} << 40}) {
        std::string bytes = w.bytes;
        std::memcpy(bytes.data() + 32, &v, 8);
        write(w.path, summed(bytes));
        CHECK(refusal(w.path) != "");
    }
}

TEST_CASE("film file: a text that promises other pixels, passes or samples is refused") {
    Written w;
    const std::string text = to_json(w.header);
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = text;
        const auto at = changed.find(from);
        REQUIRE(at != std::string::npos);
        changed.replace(at, from.size(), to);
        std::vector<NamedBytes> arrays;
        Film& film = w.film;
        for (const Film::Array& a : film.arrays()) arrays.push_back({a.name, a.bytes});
        const auto states = states_of(film).coverage;
        const IdCoverageState& s = states.at(0);
        arrays.push_back({"CryptoObject.sizes", std::as_bytes(std::span(s.sizes))});
        arrays.push_back({"CryptoObject.keys", std::as_bytes(std::span(s.keys))});
        arrays.push_back({"CryptoObject.counts", std::as_bytes(std::span(s.counts))});
        arrays.push_back({"CryptoObject.dropped_at", std::as_bytes(std::span(s.dropped_at))});
        arrays.push_back({"CryptoObject.dropped", std::as_bytes(std::span(s.dropped))});
        write_array_file(w.path, changed, arrays);
        return refusal(w.path);
    };
    CHECK(with("\"seconds\"", "\"seconds\"") == "");
    const std::string window = "  -2,\n  3,\n  5,\n  7";
    for (const char* other : {"0,0,1000000,1000000", "-2,3,5,8", "5,3,-2,7", "0,0,0,0", "1,2,3",
                              "-2,3,5,99999999999999999999", "\"a\",3,5,7", "0.5,3,5,7"}) {
        INFO(other);
        CHECK(with(window, other) != "");
    }
    CHECK(with("\"source\": \"variance\"", "\"source\": \"albedo\"") == "");  // as many numbers
    CHECK(with("\"source\": \"variance\"", "\"source\": \"p\"") != "");
    CHECK(with("\"source\": \"variance\"", "\"source\": \"none\"") != "");
    CHECK(with("\"least_samples\": 3", "\"least_samples\": 2").find("samples") !=
          std::string::npos);
    CHECK(with("\"most_samples\": 3", "\"most_samples\": -1") != "");
    CHECK(with("\"first_sample\": 4", "\"first_sample\": 4294967296") != "");
    CHECK(with("\"first_sample\": 4", "\"first_sample\": true") != "");
    CHECK(with("\"scene_hash\"", "\"scene_hush\"") != "");
    CHECK(with("{", "[") != "");
    // Two names are not enough for the keys that were counted.
    CHECK(with("    7,\n    4294967295,\n    3", "7, 4294967295").find("names") !=
          std::string::npos);
}

TEST_CASE("film file: a header tells what differs, and in which order") {
    const FilmHeader a = header_of(kSome);
    const auto what = [&](const std::function<void(FilmHeader&)>& change) -> std::string {
        FilmHeader b = a;
        change(b);
        const auto d = difference(a, b);
        if (!d) return "";
        CHECK(d->a != d->b);
        return d->what;
    };
    CHECK(what([](FilmHeader& b) { b.window.x1 = 4, b.most = 9, b.seconds = 2, b.scene = "b"; }) ==
          "");
    CHECK(what([](FilmHeader& b) { b.version = "9", b.seed = 1; }) == "version of Tessera");
    CHECK(what([](FilmHeader& b) { b.width = 9, b.scene_hash = "c"; }) == "resolution");
    CHECK(what([](FilmHeader& b) { b.seed = 1, b.scene_hash = "c"; }) == "seed");
    CHECK(what([](FilmHeader& b) { b.extras.deep = true; }) == "set of depths (--deep)");
    CHECK(what([](FilmHeader& b) { b.isa = "sse2"; }) == "instruction set (--isa)");
    CHECK(what([](FilmHeader& b) { b.working_space = "lin_rec709"; }) == "working space");
    CHECK(what([](FilmHeader& b) { b.passes[5].expression = "C<RD>O"; }) == "pass 6");
    CHECK(what([](FilmHeader& b) { b.passes.pop_back(), b.ids.pop_back(); }) == "pass 7");
    CHECK(what([](FilmHeader& b) { b.scene_hash = "c"; }) == "hash of the scene and its files");
}

TEST_CASE("film file: what cannot be written leaves what was there") {
    Written w;
    std::filesystem::create_directory(w.folder / "b.tsf");
    CHECK_THROWS_AS(write_film_file(w.folder / "b.tsf", w.header, w.film), Error);
    CHECK_THROWS_AS(write_film_file(w.folder / "none/b.tsf", w.header, w.film), Error);
    CHECK(bytes_of(w.path) == w.bytes);
    CHECK(w.folder.count() == 2);
    CHECK(names_film_file("a.TSF"));
    CHECK(!names_film_file(".tsf"));
    CHECK(!names_film_file("a.tsf.exr"));
}
