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
    // Without .tx files their finest levels are left out, and that is told.
    TextureOptions one_kib = tight("");
    one_kib.memory_bytes = 1024;
    without.load({aces, named}, TextureUse::color, one_kib);
    CHECK(without->counts().cached == 0);
    CHECK(without.problems.warnings().size() == 2);
}

TEST_CASE("texture memory: an untiled picture is halved until it fits, and its name is told") {
    const TempFolder folder;
    const std::vector<std::string> files = {folder / "a.tif", folder / "b.tif", folder / "c.tif"};
    write_tiff(files[0], 150, 97, 3, 0, noise_bytes(150 * 97 * 3));
    write_tiff(files[1], 151, 98, 4, 2, noise_bytes(151 * 98 * 4));
    std::vector<std::uint16_t> deep;
    for (const std::uint8_t b : noise_bytes(30 * 30)) deep.push_back(std::uint16_t(b * 211));
    write_tiff(files[2], 30, 30, 1, 0, deep);
    TextureOptions options;
    // a takes 63 000 bytes, b 84 000 and c 4000; at half the size 16 000 and 22 000.
    options.memory_bytes = 100000;
    std::vector<TextureDesc> descs;
    for (const std::string& file : files)
        for (const TextureDesc& desc : every_filter(file)) descs.push_back(desc);
    for (const TextureUse use : {TextureUse::data, TextureUse::color}) {
        TestStore whole, halved;
        whole.load(descs, use);
        halved.load(descs, use, options);
        CHECK(halved->counts().cached == 0);
        const auto told = halved.problems.warnings();
        REQUIRE(told.size() == 1);
        CHECK(told[0].find(
                  files[1] +
                  "': untiled, too slow for the tile cache; read as 75x49 in place of 151x98") !=
              std::string::npos);
        CHECK(told[0].find("--auto-tx") != std::string::npos);
        CHECK(whole.problems.warnings().empty());
        // What is left is what it was: the texels of level 1 by the trilinear filter, which comes
        // first.
        const int each = whole->size() / 3;
        for (int x = 0; x < 75; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / 75, v = 20.5f / 49;
            const Texel a = whole->sample(each, u, v, 2.0f / 151);
            const Texel b = halved->sample(each, u, v, 0);
            for (std::size_t c = 0; c < 4; ++c)  // of the weights
                CHECK(std::abs(a[c] - b[c]) <= 1e-5f);
            // The footprint still chooses by the picture's own size: level 2, or 0.99 above 1.
            const Texel wide_a = whole->sample(each, u, v, 4.0f / 151);
            const Texel wide_b = halved->sample(each, u, v, 4.0f / 151);
            for (std::size_t c = 0; c < 4; ++c) CHECK(std::abs(wide_a[c] - wide_b[c]) <= 0.02f);
        }
        int unequal = 0;
        for (int t = 0; t < whole->size(); ++t)
            for (float u = -0.73f; t / each != 1 && u < 2; u += 0.0971f)
                unequal += whole->sample(t, u, 0.37f, 0, 5) != halved->sample(t, u, 0.37f, 0, 5);
        CHECK(unequal == 0);
        CHECK(whole->mean(each) == halved->mean(each));
        CHECK(halved->memory_bytes() <= options.memory_bytes);
    }
}

TEST_CASE("texture memory: no limit is too small for what cannot be in the cache") {
    const TempFolder folder;
    std::vector<TextureDesc> descs;
    for (int i = 0; i < 3; ++i) {
        const std::string path = folder / (std::to_string(i) + ".tif");
        write_tiff(path, 50 + i, 9, 1, 0, noise_bytes(static_cast<std::size_t>(50 + i) * 9));
        descs.push_back(texture_of(path));
    }
    TestStore memory, least;
    memory.load(descs);
    least.load(descs, TextureUse::data, tight(""));
    CHECK(least.problems.warnings().size() == 3);
    CHECK(least.problems.warnings()[2].find("read as 1x1 in place of 52x9") != std::string::npos);
    for (int t = 0; t < 3; ++t)  // a byte's rounding
        CHECK(least->sample(t, 0.3f, 0.6f, 0)[0] ==
              doctest::Approx(memory->mean(t)[0]).epsilon(1.0 / 128));
}

TEST_CASE("auto-tx: where everything fits it changes nothing, whatever the size") {
    const TempFolder folder;
    constexpr int kSize = 800;
    std::vector<std::uint16_t> values(std::size_t(kSize) * kSize);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint16_t>(i % 65521 ^ i / kSize % 241);
    write_tiff(folder / "big.tif", kSize, kSize, 1, 0, values);
    TextureOptions options = tight(folder / "tx");
    options.in_core_bytes = 1 << 20;  // the picture has more
    options.memory_bytes = 128 << 20;
    const std::vector<TextureDesc> desc{texture_of(folder / "big.tif")};
    TestStore without, with, tiled;
    without.load(desc, TextureUse::color);
    with.load(desc, TextureUse::color, options);
    CHECK_FALSE(fs::exists(folder / "tx"));
    check_equal(without, with);
    options.memory_bytes = 1 << 20;
    tiled.load(desc, TextureUse::color, options);
    CHECK(tiled->counts().cached == 1);
    check_equal(without, tiled);
    // What is tiled is read as a whole by nobody.
    const std::string tx = fs::directory_iterator(folder / "tx")->path().string();
    TestStore large;
    options.memory_bytes = 128 << 20;
    large.load({texture_of(tx)}, TextureUse::color, options);
    CHECK(large->counts().cached == 1);
    CHECK(large->memory_bytes() < 1 << 20);
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

TEST_CASE("auto-tx: a folder that cannot be made is a warning, and memory takes what it can") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 40, 40, 1, 0, noise_bytes(1600));
    std::ofstream(folder / "tx") << "in the way";
    TestStore memory, cache;
    TextureOptions options = tight("");
    options.memory_bytes = 1200;
    memory.load({texture_of(folder / "a.tif")}, TextureUse::data, options);
    options = tight(folder / "tx");
    options.memory_bytes = 1200;
    cache.load({texture_of(folder / "a.tif")}, TextureUse::data, options);
    REQUIRE(cache.problems.warnings().size() == 2);
    CHECK(cache.problems.warnings()[0].find("no .tx") != std::string::npos);
    CHECK(cache.problems.warnings()[1].find("read as 20x20") != std::string::npos);
    CHECK(cache->counts().in_core == 1);
    check_equal(memory, cache);
}

TEST_CASE("auto-tx: a .tx that is damaged is a warning, and the file itself is read") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 40, 40, 1, 0, noise_bytes(1600));
    write_tiff(folder / "b.tif", 24, 24, 1, 0, noise_bytes(576));
    const std::vector<TextureDesc> descs{texture_of(folder / "a.tif"),
                                         texture_of(folder / "b.tif")};
    TextureOptions options = tight(folder / "tx");
    options.memory_bytes = 2600;  // either of them, not both
    TestStore memory, first, second;
    memory.load(descs);
    first.load(descs, TextureUse::data, options);
    REQUIRE(first->counts().cached > 0);
    for (const auto& entry : fs::directory_iterator(folder / "tx"))
        if (entry.path().filename().string().starts_with("a.")) fs::resize_file(entry.path(), 10);
    second.load(descs, TextureUse::data, options);
    CHECK(second.problems.warnings().size() >= 1);
    CHECK(second.problems.warnings()[0].find("no .tx") != std::string::npos);
    CHECK(second->counts().in_core >= 1);
    for (float u = 0; u < 1; u += 0.1f)
        CHECK(memory->sample(1, u, 0.3f, 0) == second->sample(1, u, 0.3f, 0));
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
    options.auto_tx = true;
    options.tx_folder = folder / "tx";
    Workers workers(2);
    TestStore one, many;
    one.load(descs, TextureUse::color, options);
    many.load(descs, TextureUse::color, options, &workers);
    CHECK(one->counts().in_core == 4);
    CHECK(one->counts().cached == 4);
    CHECK(many->counts().cached == 4);
    TestStore halved, halved_too;
    options.auto_tx = false;
    halved.load(descs, TextureUse::color, options);
    halved_too.load(descs, TextureUse::color, options, &workers);
    CHECK(halved.problems.warnings().size() == 3);
    CHECK(halved.problems.warnings() == halved_too.problems.warnings());
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
    REQUIRE(over.problems.warnings().size() == 1);  // the first of the largest
    CHECK(over.problems.warnings()[0].find("a.tif") != std::string::npos);
    CHECK(over->memory_bytes() < options.memory_bytes);
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
