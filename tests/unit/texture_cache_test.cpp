// The tile cache, .tx files and the limit on memory.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "renderer/api/image.h"
#include "renderer/core/parallel.h"
#include "renderer/image/tx_file.h"
#include "tests/support/temp_folder.h"
#include "tests/support/texture_stores.h"

using namespace tessera;

namespace {

namespace fs = std::filesystem;

TextureOptions tight(const std::string& tx_folder) {
    TextureOptions options;
    options.memory_bytes = 1;  // nothing fits
    options.auto_tx = !tx_folder.empty();
    options.tx_folder = tx_folder;
    return options;
}

std::vector<TextureDesc> every_filter(const std::string& file) {
    std::vector<TextureDesc> descs;
    for (const TextureFilter filter : kTextureFilters)
        for (const Wrap wrap : kWraps) descs.push_back(texture_of(file, filter, wrap));
    return descs;
}

void check_equal(const TestStore& a, const TestStore& b) {
    int unequal = 0;
    for (int t = 0; t < a->size(); ++t)
        for (float u = -0.73f; u < 2; u += 0.0971f)
            for (float v = -0.61f; v < 2; v += 0.1137f)
                for (const float width : {0.0f, 0.011f, 0.07f, 2.0f})
                    unequal += a->sample(t, u, v, width, 5) != b->sample(t, u, v, width, 5);
    CHECK(unequal == 0);
}

}  // namespace

TEST_CASE("tile cache: out of a .tx come the bits of a picture in memory, by every filter") {
    const TempFolder folder;
    write_tiff(folder / "grey.tif", 150, 97, 1, 0, noise_bytes(150 * 97));
    write_tiff(folder / "ga.tif", 70, 33, 2, 2, noise_bytes(70 * 33 * 2));
    write_tiff(folder / "rgb.tif", 130, 65, 3, 0, noise_bytes(130 * 65 * 3));
    write_tiff(folder / "rgba.tif", 65, 64, 4, 2, noise_bytes(65 * 64 * 4));
    std::vector<std::uint16_t> deep;
    for (const std::uint8_t b : noise_bytes(80 * 80))
        deep.push_back(static_cast<std::uint16_t>(b * 211));
    write_tiff(folder / "deep.tif", 80, 80, 1, 0, deep);
    std::vector<float> floats;
    for (const std::uint8_t b : noise_bytes(90 * 40))
        floats.push_back(static_cast<float>(b) * 0.37f);
    write_tiff(folder / "float.tif", 90, 40, 1, 0, floats);
    for (const std::string file :
         {"grey.tif", "ga.tif", "rgb.tif", "rgba.tif", "deep.tif", "float.tif"})
        for (const TextureUse use : {TextureUse::data, TextureUse::color}) {
            CAPTURE(file);
            CAPTURE(int(use));
            TestStore memory, cache;
            memory.load(every_filter(folder / file), use);
            cache.load(every_filter(folder / file), use, tight(folder / "tx"));
            REQUIRE(memory->counts().in_core == 1);
            REQUIRE(cache->counts().cached == 1);
            CHECK(cache.problems.warnings().empty());
            check_equal(memory, cache);
            CHECK(cache->counts().failures == 0);
            CHECK(memory->has_alpha(0) == cache->has_alpha(0));
            CHECK(memory->mean(0) == cache->mean(0));
            for (int c = 0; c < 4; ++c)
                CHECK(memory->channel_is_one(0, c) == cache->channel_is_one(0, c));
        }
}

TEST_CASE("tile cache: a converted colour space and a misnamed file are read through .tx files") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 66, 50, 3, 0, noise_bytes(66 * 50 * 3));
    fs::copy_file(folder / "a.tif", folder / "a.png");  // a TIFF inside
    TextureDesc aces = texture_of(folder / "a.tif"), named = texture_of(folder / "a.png");
    aces.color_space = "acescg";
    TestStore memory, cache, without;
    memory.load({aces, named}, TextureUse::color);
    cache.load({aces, named}, TextureUse::color, tight(folder / "tx"));
    CHECK(cache->counts().cached == 2);
    check_equal(memory, cache);
    // Without .tx files they stay in memory, and the broken limit is told.
    TextureOptions one_kib = tight("");
    one_kib.memory_bytes = 1024;
    without.load({aces, named}, TextureUse::color, one_kib);
    CHECK(without->counts().cached == 0);
    REQUIRE(without.problems.warnings().size() == 1);
    CHECK(without.problems.warnings()[0].find("--auto-tx") != std::string::npos);
    check_equal(memory, without);
}

TEST_CASE("tile cache: an untiled file without a .tx reads its finest level exactly") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 150, 97, 3, 0, noise_bytes(150 * 97 * 3));
    TestStore memory, cache;
    memory.load(every_filter(folder / "a.tif"), TextureUse::color);
    cache.load(every_filter(folder / "a.tif"), TextureUse::color, tight(""));
    REQUIRE(cache->counts().cached == 1);
    REQUIRE(cache.problems.notes().size() == 1);
    CHECK(cache.problems.notes()[0].find("--auto-tx") != std::string::npos);
    for (int t = 0; t < memory->size(); ++t)
        for (float u = -0.7f; u < 2; u += 0.031f)
            CHECK(memory->sample(t, u, 0.37f, 0, 9) == cache->sample(t, u, 0.37f, 0, 9));
}

TEST_CASE("auto-tx: files are made once, and anew for a file that changed") {
    const TempFolder folder;
    const std::string tx = folder / "tx";
    write_tiff(folder / "a.tif", 40, 40, 1, 0, noise_bytes(1600));
    const auto files = [&] {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(tx)) found.push_back(entry.path());
        return found;
    };
    TestStore first, second, third;
    first.load({texture_of(folder / "a.tif")}, TextureUse::data, tight(tx));
    REQUIRE(files().size() == 1);
    const fs::path made = files()[0];
    CHECK(made.filename().string().starts_with("a."));
    CHECK(made.extension() == ".tx");
    CHECK(first.problems.notes() ==
          std::vector<std::string>{"auto-tx: 1 .tx made, 0 there from before"});
    const auto time = fs::last_write_time(made);
    second.load({texture_of(folder / "a.tif")}, TextureUse::data, tight(tx));
    CHECK(second.problems.notes() ==
          std::vector<std::string>{"auto-tx: 0 .tx made, 1 there from before"});
    CHECK(fs::last_write_time(made) == time);
    check_equal(first, second);

    write_tiff(folder / "a.tif", 40, 41, 1, 0, noise_bytes(1640, 3));
    third.load({texture_of(folder / "a.tif")}, TextureUse::data, tight(tx));
    CHECK(files().size() == 2);
    TestStore memory;
    memory.load({texture_of(folder / "a.tif")});
    check_equal(memory, third);
    // One for colours is another file than one for data.
    TestStore color;
    color.load({texture_of(folder / "a.tif")}, TextureUse::color, tight(tx));
    CHECK(files().size() == 3);
}

TEST_CASE("auto-tx: a folder that cannot be made is a warning, and the file itself is read") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 40, 40, 1, 0, noise_bytes(1600));
    std::ofstream(folder / "tx") << "in the way";
    TestStore memory, cache;
    memory.load({texture_of(folder / "a.tif", TextureFilter::closest)});
    cache.load({texture_of(folder / "a.tif", TextureFilter::closest)}, TextureUse::data,
               tight(folder / "tx"));
    REQUIRE(cache.problems.warnings().size() == 1);
    CHECK(cache.problems.warnings()[0].find("no .tx") != std::string::npos);
    CHECK(cache->counts().cached == 1);
    check_equal(memory, cache);
}

TEST_CASE("auto-tx: a .tx that is damaged is a warning, and the file itself is read") {
    const TempFolder folder;
    const std::string tx = folder / "tx";
    write_tiff(folder / "a.tif", 40, 40, 1, 0, noise_bytes(1600));
    TestStore memory, first, second;
    memory.load({texture_of(folder / "a.tif", TextureFilter::closest)});
    first.load({texture_of(folder / "a.tif", TextureFilter::closest)}, TextureUse::data, tight(tx));
    for (const auto& entry : fs::directory_iterator(tx)) fs::resize_file(entry.path(), 10);
    second.load({texture_of(folder / "a.tif", TextureFilter::closest)}, TextureUse::data,
                tight(tx));
    CHECK(second.problems.warnings().size() == 1);
    check_equal(memory, second);
}

TEST_CASE("auto-tx: a picture that is broken is reported once and makes no file") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 400, 400, 1, 0, noise_bytes(160000));
    fs::resize_file(folder / "a.tif", 90000);
    TestStore s;
    s.problems = Problems(Strictness::lenient);
    s.load({texture_of(folder / "a.tif")}, TextureUse::data, tight(folder / "tx"));
    CHECK(s.problems.warnings().size() == 1);
    CHECK_FALSE(fs::exists(folder / "tx"));
    CHECK(s->sample(0, 0.5f, 0.5f, 0)[1] == 0);
}

TEST_CASE("auto-tx: the folder follows XDG_CACHE_HOME, then HOME") {
    const auto with = [](const char* cache, const char* home) {
        const std::string old_cache =
            std::getenv("XDG_CACHE_HOME") ? std::getenv("XDG_CACHE_HOME") : "";
        const std::string old_home = std::getenv("HOME") ? std::getenv("HOME") : "";
        ::setenv("XDG_CACHE_HOME", cache, 1);
        ::setenv("HOME", home, 1);
        std::string folder = default_tx_folder();
        old_cache.empty() ? ::unsetenv("XDG_CACHE_HOME")
                          : ::setenv("XDG_CACHE_HOME", old_cache.c_str(), 1);
        old_home.empty() ? ::unsetenv("HOME") : ::setenv("HOME", old_home.c_str(), 1);
        return folder;
    };
    CHECK(with("/c", "/h") == "/c/tessera/tx");
    CHECK(with("", "/h") == "/h/.cache/tessera/tx");
    CHECK(with("relative", "/h") == "/h/.cache/tessera/tx");
    CHECK(with("", "").empty());
}

TEST_CASE("texture memory: what stays in memory is decided by sizes and order, not by threads") {
    const TempFolder folder;
    std::vector<TextureDesc> descs;
    for (int i = 0; i < 8; ++i) {
        const int size = 64 + 32 * (i * 5 % 8);
        const std::string path = folder / (std::to_string(i) + ".tif");
        write_tiff(path, size, size, 1, 0, noise_bytes(static_cast<std::size_t>(size * size)));
        descs.push_back(texture_of(path));
    }
    TextureOptions options;
    options.memory_bytes = 200000;  // all are 265 000 bytes, a half of this takes the smallest four
    Workers workers(2);
    TestStore one, many;
    one.load(descs, TextureUse::color, options);
    many.load(descs, TextureUse::color, options, &workers);
    CHECK(one->counts().in_core == 4);
    CHECK(one->counts().cached == 4);
    CHECK(one.problems.notes() == many.problems.notes());
    for (int t = 0; t < 8; ++t)
        for (const float u : {0.1f, 0.43f, 0.77f})
            CHECK(one->sample(t, u, 0.3f, 0.1f) == many->sample(t, u, 0.3f, 0.1f));
}

TEST_CASE("texture memory: everything stays in memory while it fits") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 64, 64, 1, 0, noise_bytes(4096));
    write_tiff(folder / "b.tif", 64, 64, 1, 0, noise_bytes(4096, 1));
    TextureOptions options;
    options.memory_bytes = 2 * 5632;  // 64 x 64 and below, in blocks of 8 x 8
    TestStore fits, over;
    fits.load({texture_of(folder / "a.tif"), texture_of(folder / "b.tif")}, TextureUse::data,
              options);
    CHECK(fits->counts().cached == 0);
    options.memory_bytes -= 1;
    over.load({texture_of(folder / "a.tif"), texture_of(folder / "b.tif")}, TextureUse::data,
              options);
    CHECK(over->counts().cached > 0);
}

TEST_CASE("texture memory: the limit holds while four times as much is read") {
    const TempFolder folder;
    std::vector<TextureDesc> descs;
    for (int i = 0; i < 24; ++i) {  // 2.7 MiB each
        const std::string path = folder / (std::to_string(i) + ".tif");
        write_tiff(path, 1024, 1024, 2, 0, noise_bytes(2 << 20, static_cast<std::uint32_t>(i)));
        descs.push_back(texture_of(path, TextureFilter::closest));
    }
    TextureOptions options;
    options.memory_bytes = 24 << 20;
    options.auto_tx = true;
    options.tx_folder = folder / "tx";
    TestStore s;
    s.load(descs, TextureUse::data, options);
    CHECK(s->counts().cached >= 16);
    std::int64_t most = 0;
    for (int pass = 0; pass < 2; ++pass)
        for (int t = 0; t < s->size(); ++t) {
            for (int k = 0; k < 256; ++k)  // every tile of 64 x 64 once
                s->sample(t, (static_cast<float>(k % 16) + 0.5f) / 16,
                          (static_cast<float>(k / 16) + 0.5f) / 16, 0);
            most = std::max(most, s->memory_bytes());
        }
    CHECK(s->counts().bytes_read > 64 << 20);
    CHECK(most <= options.memory_bytes);
    CHECK(most > 12 << 20);
}
