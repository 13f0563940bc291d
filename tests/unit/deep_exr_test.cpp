#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "renderer/api/deep.h"
#include "renderer/image/check/check_exr.h"
#include "renderer/image/check/exr_raw.h"
#include "renderer/image/deep_reader.h"
#include "tests/support/temp_folder.h"

using namespace tessera;

namespace {

constexpr int kWidth = 24, kHeight = 9;

// Pixels of 0 to 23 depths, some with a bright background, the shares of 4096 camera samples each.
DeepImage make_image(std::uint32_t seed = 4) {
    std::mt19937 random(seed);
    DeepImage image;
    image.width = kWidth;
    image.height = kHeight;
    image.window = {0, 0, kWidth, kHeight};
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const auto depths = static_cast<std::uint32_t>(i % kWidth);
        std::uint32_t left = 4096;
        for (std::uint32_t d = 0; d < depths; ++d) {
            const bool last = d + 1 == depths && i % 2 == 0;  // covers all
            const std::uint32_t count =
                last ? left : 1 + static_cast<std::uint32_t>(random() % (left / 24));
            left -= count;
            const double share = count / 4096.0;
            DeepSample s{static_cast<float>(d + 1), {}, share};
            for (float& c : s.rgb)
                c = static_cast<float>(share * static_cast<double>(500 + random() % 500) * 0.01);
            image.samples.push_back(s);
        }
        image.counts.push_back(depths);
        if (left > 0 && left < 4096) {
            const auto light = static_cast<float>(left / 4096.0 * 500.0);
            image.samples.push_back({kDeepBackground, {light, light, light}, 0});
            ++image.counts.back();
        }
    }
    image.metadata = {{"tessera/spp", 4096}};
    return image;
}

struct Flat {
    std::array<double, 4> rgba{}, last{};  // the sum, and what the last sample gave to it
    float z = kDeepBackground;
};

std::vector<Flat> sums_of(const DeepImage& image) {
    std::vector<Flat> out;
    const DeepSample* s = image.samples.data();
    for (const std::uint32_t count : image.counts) {
        Flat pixel;
        for (std::uint32_t i = 0; i < count; ++i, ++s) {
            for (std::size_t c = 0; c < 3; ++c) pixel.rgba[c] += static_cast<double>(s->rgb[c]);
            pixel.rgba[3] += s->alpha;
            pixel.last = {static_cast<double>(s->rgb[0]), static_cast<double>(s->rgb[1]),
                          static_cast<double>(s->rgb[2]), s->alpha > 0 ? s->alpha : pixel.last[3]};
            if (s->alpha > 0) pixel.z = std::min(pixel.z, s->z);
        }
        out.push_back(pixel);
    }
    return out;
}

WriteOptions options(bool all_float, ExrCompression codec = ExrCompression::zip) {
    WriteOptions o;
    o.all_float = all_float;
    o.compression = codec;
    return o;
}

LayeredImage flatten(std::vector<std::string> paths) { return flatten_deep_exr(paths); }

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void put(const std::string& path, const std::string& bytes) { write_anew(path, bytes); }

// Empty if the file can be flattened, else what is said of it, which must be an error of the input.
std::string complaint(const std::string& path) {
    try {
        flatten({path});
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        return error.what();
    }
    return {};
}

// Where the chunk of line y begins.
std::size_t chunk_of(const std::string& path, const std::string& bytes, int y) {
    const RawExr raw = read_raw_exr(path);
    std::uint64_t offset = 0;
    std::memcpy(&offset, &bytes[raw.parts[0].table + 8 * static_cast<std::size_t>(y)], 8);
    return offset;
}

DeepImage one_pixel(float z, float light, double alpha) {
    DeepImage image;
    image.width = image.height = 1;
    image.window = {0, 0, 1, 1};
    image.counts = {1};
    image.samples = {{z, {light, light, light}, alpha}};
    return image;
}

}  // namespace

TEST_CASE("deep exr: flattened floats are the sum of what was written, by either codec") {
    const TempFolder folder;
    const DeepImage image = make_image();
    const std::vector<Flat> wanted = sums_of(image);
    for (const ExrCompression codec : {ExrCompression::none, ExrCompression::zip}) {
        write_deep_exr(image, image.window, folder / "d.exr", options(true, codec));
        CHECK(folder.count() == 1);  // nothing beside it
        const LayeredImage flat = flatten({folder / "d.exr"});
        REQUIRE(flat.layers.size() == 2);
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            for (std::size_t c = 0; c < 4; ++c) {
                const auto found = static_cast<double>(flat.layers[0].pixels[i * 4 + c]);
                // Two roundings to float, of the last sample and of the sum.
                CHECK(std::fabs(found - wanted[i].rgba[c]) <= 2e-7 * wanted[i].rgba[c]);
            }
            CHECK(flat.layers[1].pixels[i] == wanted[i].z);
        }
    }
}

TEST_CASE("deep exr: rounding to halves does not add up, however many samples there are") {
    const TempFolder folder;
    const DeepImage image = make_image();
    const std::vector<Flat> wanted = sums_of(image);
    write_deep_exr(image, image.window, folder / "d.exr", options(false));
    const LayeredImage flat = flatten({folder / "d.exr"});
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        for (std::size_t c = 0; c < 4; ++c) {
            const auto found = static_cast<double>(flat.layers[0].pixels[i * 4 + c]);
            // Half's rounding, 2^-11, of the last sample and what rounding left for it; no more.
            const double tolerance = 0x1p-11 * wanted[i].last[c] + 1e-6 * wanted[i].rgba[c];
            CHECK(std::fabs(found - wanted[i].rgba[c]) <= tolerance);
        }
        const bool full = wanted[i].rgba[3] == 1;
        if (full) CHECK(flat.layers[0].pixels[i * 4 + 3] == 1.0f);
    }
}

TEST_CASE("deep exr: what rounding takes from a sample the next one has") {
    // Each would be rounded down to 1; together they are 20.008.
    const float light = 1.0004f;
    const std::vector<DeepSample> shares(20, {2, {light, light, light}, 0});
    DeepLine line;
    WriteReport report;
    append_over(shares, true, line, report);
    double sum = 0;
    for (const DeepValue& v : line.values) sum += static_cast<double>(v.rgba[0]);
    CHECK(sum == doctest::Approx(20 * 1.0004).epsilon(0x1p-11 / 20));  // the last one's rounding
}

TEST_CASE("deep exr: a window of the image, or one beyond it, has the same pixels") {
    const TempFolder folder;
    const DeepImage image = make_image();
    write_deep_exr(image, image.window, folder / "all.exr", options(true));
    write_deep_exr(image, {5, 2, 30, 8}, folder / "part.exr", options(true));
    const LayeredImage all = flatten({folder / "all.exr"}), part = flatten({folder / "part.exr"});
    REQUIRE(part.window == PixelWindow{5, 2, 30, 8});
    for (int y = 2; y < 8; ++y) {
        for (int x = 5; x < 30; ++x) {
            for (int c = 0; c < 4; ++c) {
                const float wanted =
                    x < kWidth ? all.layers[0].pixels[(y * kWidth + x) * 4 + c] : 0.0f;
                REQUIRE(part.layers[0].pixels[((y - 2) * 25 + x - 5) * 4 + c] == wanted);
            }
        }
    }
}

TEST_CASE("deep exr: merging is by depth and not by the order of the files") {
    const TempFolder folder;
    write_deep_exr(one_pixel(2, 0.25f, 0.25), {0, 0, 1, 1}, folder / "near.exr", options(true));
    write_deep_exr(one_pixel(3, 4.0f, 1), {0, 0, 1, 1}, folder / "far.exr", options(true));
    const LayeredImage a = flatten({folder / "near.exr", folder / "far.exr"});
    const LayeredImage b = flatten({folder / "far.exr", folder / "near.exr"});
    CHECK(a.layers[0].pixels[0] == 0.25f + 0.75f * 4.0f);
    CHECK(a.layers[0].pixels[3] == 1.0f);
    CHECK(a.layers[1].pixels[0] == 2.0f);
    CHECK(a.layers[0].pixels == b.layers[0].pixels);
}

TEST_CASE("deep exr: of several backgrounds the first file's is seen") {
    const TempFolder folder;
    write_deep_exr(one_pixel(kDeepBackground, 5, 0), {0, 0, 1, 1}, folder / "a.exr", options(true));
    write_deep_exr(one_pixel(kDeepBackground, 7, 0), {0, 0, 1, 1}, folder / "b.exr", options(true));
    CHECK(flatten({folder / "a.exr", folder / "b.exr"}).layers[0].pixels[0] == 5.0f);
    CHECK(flatten({folder / "b.exr", folder / "a.exr"}).layers[0].pixels[0] == 7.0f);
    CHECK(flatten({folder / "a.exr"}).layers[1].pixels[0] == kDeepBackground);
}

TEST_CASE("deep exr: files of other frames or primaries are not merged") {
    const TempFolder folder;
    DeepImage image = make_image();
    write_deep_exr(image, image.window, folder / "a.exr", options(true));
    image.working_space = "acescg";
    write_deep_exr(image, image.window, folder / "b.exr", options(true));
    write_deep_exr(one_pixel(2, 1, 1), {0, 0, 1, 1}, folder / "c.exr", options(true));
    CHECK(flatten({folder / "b.exr"}).working_space == "acescg");
    CHECK_THROWS_AS(flatten({folder / "a.exr", folder / "b.exr"}), Error);
    CHECK_THROWS_AS(flatten({folder / "a.exr", folder / "c.exr"}), Error);
}

TEST_CASE("deep exr: what half cannot hold is clamped and counted") {
    const TempFolder folder;
    const WriteReport report =
        write_deep_exr(one_pixel(2, 1e6f, 1), {0, 0, 1, 1}, folder / "a.exr", options(false));
    CHECK(report.clamped == 3);
    CHECK(flatten({folder / "a.exr"}).layers[0].pixels[0] == 65504.0f);
}

TEST_CASE("deep exr: depths and colours that are no numbers are refused with their place") {
    const TempFolder folder;
    DeepImage image = make_image();
    const std::string path = folder / "d.exr";
    write_deep_exr(image, image.window, path, options(true, ExrCompression::none));
    const std::string good = contents(path);
    // Line 3: counts, then the planes A, B, G, R, Z of all its samples.
    const std::size_t chunk = chunk_of(path, good, 3);
    std::uint64_t table = 0, size = 0;
    std::memcpy(&table, &good[chunk + 4], 8);
    std::memcpy(&size, &good[chunk + 12], 8);
    const std::size_t plane = size / 5, first = chunk + 28 + table;
    const auto spoiled = [&](std::size_t at, float value) {
        std::string bad = good;
        std::memcpy(&bad[first + at], &value, 4);
        put(path, bad);
        return complaint(path);
    };
    // The first sample of the line is the only one of pixel 1.
    CHECK(spoiled(4 * plane, NAN).find("pixel 1,3, sample 0: its depth") != std::string::npos);
    CHECK(spoiled(4 * plane, -INFINITY).find("its depth") != std::string::npos);
    CHECK(spoiled(3 * plane, INFINITY).find("pixel 1,3, sample 0: its colour") !=
          std::string::npos);
    CHECK(spoiled(0, -1).find("its alpha") != std::string::npos);
    CHECK(spoiled(4 * plane, INFINITY).empty());  // others write the background so
}

TEST_CASE("deep exr: sizes that a file cannot have are refused before memory is taken") {
    const TempFolder folder;
    const DeepImage image = make_image();
    const std::string path = folder / "d.exr";
    write_deep_exr(image, image.window, path, options(false));
    const std::string good = contents(path);
    const std::size_t chunk = chunk_of(path, good, 5);
    const auto spoiled = [&](std::size_t at, std::uint64_t value, std::size_t bytes = 8) {
        std::string bad = good;
        std::memcpy(&bad[chunk + at], &value, bytes);
        put(path, bad);
        return complaint(path);
    };
    CHECK(spoiled(0, 99, 4).find("line 5: it is no line") != std::string::npos);
    CHECK(spoiled(4, std::uint64_t(1) << 60).find("line 5") != std::string::npos);
    CHECK(spoiled(12, UINT64_MAX).find("line 5") != std::string::npos);
    CHECK(spoiled(20, std::uint64_t(1) << 34).find("line 5") != std::string::npos);
    CHECK(spoiled(20, 1).find("d.exr") != std::string::npos);
}

TEST_CASE("deep exr: a file cut short anywhere is refused") {
    const TempFolder folder;
    const DeepImage image = make_image();
    const std::string path = folder / "d.exr";
    for (const ExrCompression codec : {ExrCompression::none, ExrCompression::zip}) {
        write_deep_exr(image, image.window, path, options(false, codec));
        const std::string good = contents(path);
        for (std::size_t size = 0; size < good.size(); size += 37) {
            put(path, good.substr(0, size));
            CHECK(!complaint(path).empty());
        }
        put(path, good.substr(0, good.size() - 1));
        CHECK(!complaint(path).empty());
    }
}

TEST_CASE("deep exr: damaged bytes are refused or flattened, and never more") {
    const TempFolder folder;
    const DeepImage image = make_image();
    const std::string path = folder / "d.exr";
    std::mt19937 random(9);
    for (const ExrCompression codec : {ExrCompression::none, ExrCompression::zip}) {
        write_deep_exr(image, image.window, path, options(false, codec));
        const std::string good = contents(path);
        int refused = 0;
        for (int i = 0; i < 1500; ++i) {
            std::string bad = good;
            for (int n = 0; n < 1 + i % 3; ++n)
                bad[random() % bad.size()] = static_cast<char>(random());
            put(path, bad);
            refused += !complaint(path).empty();
        }
        CHECK(refused > 100);
    }
}

TEST_CASE("deep exr: exrcheck finds nothing wrong with it, and finds what is missing") {
    const TempFolder folder;
    const DeepImage image = make_image();
    const std::string path = folder / "d.exr";
    write_deep_exr(image, image.window, path, options(false));
    for (const ExrFinding& f : check_exr(path)) CHECK(f.rule == ExrRule::deep);
    const std::string good = contents(path);
    put(path, good.substr(0, good.size() - 10));
    const ExrFindings findings = check_exr(path);
    CHECK(std::any_of(findings.begin(), findings.end(),
                      [](const ExrFinding& f) { return f.rule == ExrRule::truncated; }));
}
