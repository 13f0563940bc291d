#include "renderer/film/cryptomatte.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/core/murmur3.h"
#include "renderer/image/exr_layers.h"
#include "tests/support/temp_folder.h"

using namespace tessera;
using namespace std::string_literals;

namespace {

const std::vector<std::uint32_t> kIds{0x13851a76, 0x9623ac1e, 0x40000001, 0x40000002,
                                      0x40000003, 0x40000004, 0x40000005, 0x40000006};

std::uint32_t bits(float f) { return std::bit_cast<std::uint32_t>(f); }

// Rank r of a pixel: id and coverage.
std::pair<std::uint32_t, float> rank_of(const std::vector<Layer>& layers, std::size_t pixel,
                                        std::size_t r) {
    const float* p = &layers.at(r / 2).pixels[pixel * 4 + r % 2 * 2];
    return {bits(p[0]), p[1]};
}

std::string text_of(const std::vector<std::pair<std::string, MetadataValue>>& header,
                    const std::string& ending) {
    for (const auto& [name, value] : header)
        if (name.ends_with(ending)) return std::get<std::string>(value);
    FAIL("no attribute " << ending);
    return {};
}

}  // namespace

TEST_CASE("cryptomatte layers: ranks go by coverage, equal ones by id, and what is not seen is 0") {
    IdCoverage coverage(2);
    coverage.add(1, 3, 2), coverage.add(1, 1, 5), coverage.add(1, 2, 2), coverage.add(1, 0, 1);
    const std::vector<std::uint32_t> samples{16, 16};
    const auto layers = cryptomatte_layers("CryptoObject", coverage, kIds, samples);
    REQUIRE(layers.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(layers[i].name == "CryptoObject0" + std::to_string(i));
        CHECK(layers[i].channels == std::vector<std::string>{"R", "G", "B", "A"});
        CHECK(layers[i].kind == LayerKind::data);  // half floats would break every id
    }
    using Ranked = std::pair<std::uint32_t, float>;
    CHECK(rank_of(layers, 1, 0) == Ranked{kIds[1], 5.0f / 16});
    CHECK(rank_of(layers, 1, 1) == Ranked{kIds[2], 2.0f / 16});
    CHECK(rank_of(layers, 1, 2) == Ranked{kIds[3], 2.0f / 16});
    CHECK(rank_of(layers, 1, 3) == Ranked{kIds[0], 1.0f / 16});
    for (std::size_t r = 4; r < 6; ++r) CHECK(rank_of(layers, 1, r) == Ranked{0, 0.0f});
    for (std::size_t r = 0; r < 6; ++r) CHECK(rank_of(layers, 0, r) == Ranked{0, 0.0f});
}

TEST_CASE("cryptomatte layers: levels say how many ranks there are, an odd one leaves a gap") {
    IdCoverage coverage(1);
    for (std::uint32_t key = 0; key < 8; ++key) coverage.add(0, key, 8 - key);
    const std::vector<std::uint32_t> samples{36};
    const auto three = cryptomatte_layers("C", coverage, kIds, samples, 3);
    REQUIRE(three.size() == 2);
    CHECK(rank_of(three, 0, 2).first == kIds[2]);
    CHECK(rank_of(three, 0, 3) == std::pair<std::uint32_t, float>{0, 0.0f});
    CHECK(cryptomatte_layers("C", coverage, kIds, samples, 8).size() == 4);

    const CryptomatteLoss loss = cryptomatte_loss(coverage);
    CHECK(loss.crowded_pixels == 1);
    CHECK(loss.crowded_samples == 2 + 1);
    CHECK(loss.dropped_samples == 0);
    CHECK(cryptomatte_loss(coverage, 8).crowded_pixels == 0);
}

TEST_CASE("cryptomatte layers: coverages of a pixel never sum to more than 1, nor to much less") {
    // Every way to share 1..200 samples by about sevenths and thirds.
    for (std::uint32_t n = 1; n <= 200; ++n) {
        for (std::uint32_t parts = 1; parts <= 6; ++parts) {
            IdCoverage coverage(1);
            std::uint32_t left = n;
            for (std::uint32_t key = 0; key < parts && left > 0; ++key) {
                const std::uint32_t count = key + 1 == parts ? left : (left + 2) / 3;
                coverage.add(0, key, count);
                left -= count;
            }
            const std::vector<std::uint32_t> samples{n};
            const auto layers = cryptomatte_layers("C", coverage, kIds, samples);
            double sum = 0;
            for (std::size_t r = 0; r < 6; ++r)
                sum += static_cast<double>(rank_of(layers, 0, r).second);
            REQUIRE(sum <= 1);
            REQUIRE(sum >=
                    1 - 6 * 0x1p-24);  // each rounded down by less than a unit of its last place
        }
    }
}

TEST_CASE("cryptomatte header: the attributes are the specification's, under names of 31 bytes") {
    const std::vector<std::string> names{"bunny", "torus"};
    const auto header = cryptomatte_header("CryptoObject", names);
    REQUIRE(header.size() == 4);
    char key[9];
    std::snprintf(key, sizeof key, "%08x", murmur3("CryptoObject"));
    for (const auto& [name, value] : header) {
        CHECK(name.starts_with("cryptomatte/" + std::string(key, 7) + "/"));
        CHECK(name.size() <= 31);
    }
    CHECK(text_of(header, "/name") == "CryptoObject");
    CHECK(text_of(header, "/hash") == "MurmurHash3_32");
    CHECK(text_of(header, "/conversion") == "uint32_to_float32");
    CHECK(text_of(header, "/manifest") == R"({"bunny":"13851a76","torus":"f19c73fd"})");
    CHECK(murmur3("torus") == 0xf19c73fd);
}

TEST_CASE("cryptomatte manifest: names of any bytes make sound JSON, UTF-8 kept as it is") {
    const std::vector<std::string> names{"",
                                         "a\"b",
                                         "back\\slash",
                                         "tab\tline\n",
                                         "nul\0x"s,
                                         "равнина",
                                         "\x01\x1f\x7f",
                                         "/root/a:b.001",
                                         "a\xff"
                                         "b",
                                         "</script>'{}[],"};
    const std::string manifest = cryptomatte_manifest(names);
    const nlohmann::json parsed = nlohmann::json::parse(manifest);
    REQUIRE(parsed.size() == names.size());
    for (const std::string& name : names) {
        const std::string key = name == "a\xff"
                                        "b"
                                    ? "a\uFFFD"
                                      "b"
                                    : name;
        REQUIRE(parsed.contains(key));
        char id[9];
        std::snprintf(id, sizeof id, "%08x", cryptomatte_id(name));
        CHECK(parsed[key] == id);
    }
    // Blender's own parser knows no \u.
    CHECK(manifest.find("равнина") != std::string::npos);
    CHECK(cryptomatte_manifest({}) == "{}");
}

TEST_CASE("cryptomatte: ids, coverages and a manifest of megabytes come back from the file") {
    const TempFolder folder;
    std::vector<std::string> names;
    for (int i = 0; i < 100000; ++i) names.push_back("leaf \"" + std::to_string(i) + "\" лист");
    IdCoverage coverage(12);
    for (std::size_t pixel = 0; pixel < 12; ++pixel)
        for (std::uint32_t key = 0; key < pixel; ++key) coverage.add(pixel, key % 8, key + 1);
    const std::vector<std::uint32_t> samples(12, 100);

    LayeredImage image;
    image.width = 4, image.height = 3, image.window = {0, 0, 4, 3};
    image.layers = cryptomatte_layers("CryptoObject", coverage, kIds, samples);
    image.metadata = cryptomatte_header("CryptoObject", names);
    write_exr(image, folder / "c.exr");
    const LayeredImage read = read_exr(folder / "c.exr");

    CHECK(text_of(read.metadata, "/manifest") == text_of(image.metadata, "/manifest"));
    CHECK(text_of(read.metadata, "/manifest").size() > 3'000'000);
    CHECK(text_of(read.metadata, "/name") == "CryptoObject");
    REQUIRE(read.layers.size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(read.layers[i].name == image.layers[i].name);
        REQUIRE(read.layers[i].pixels.size() == image.layers[i].pixels.size());
        for (std::size_t k = 0; k < read.layers[i].pixels.size(); ++k)
            REQUIRE(bits(read.layers[i].pixels[k]) == bits(image.layers[i].pixels[k]));
    }
}
