// Sequences and sets of tiles: from the name in a scene file to what is looked up.

#include <doctest/doctest.h>

#include <fstream>

#include "renderer/io/texture_files.h"
#include "tests/support/scene_folder.h"
#include "tests/support/temp_folder.h"
#include "tests/support/texture_stores.h"

using namespace tessera;

namespace {

void touch(const std::string& path) { std::ofstream(path) << "x"; }

std::string stem(const std::string& path) { return path.substr(path.rfind('/') + 1); }

}  // namespace

TEST_CASE("sequences: each way to write a frame finds its file") {
    const TempFolder folder;
    for (const char* name : {"a.0007.png", "a.7.png", "a.12345.png", "b_007.png", "c-001.png"})
        touch(folder / name);
    const AssetRules rules(folder.path(), false);
    const auto found = [&](const std::string& name, int frame) {
        const TextureFiles files = find_texture_files(rules, name, folder.path(), frame);
        CHECK(files.missing.empty() == !files.found.path.empty());
        return stem(files.found.path);
    };
    CHECK(found("a.####.png", 7) == "a.0007.png");
    CHECK(found("a.%04d.png", 7) == "a.0007.png");
    CHECK(found("a.<F4>.png", 7) == "a.0007.png");
    CHECK(found("a.<f4>.png", 7) == "a.0007.png");
    CHECK(found("a.#.png", 7) == "a.7.png");
    CHECK(found("a.%d.png", 7) == "a.7.png");
    CHECK(found("a.<frame>.png", 7) == "a.7.png");
    CHECK(found("a.<F>.png", 7) == "a.7.png");
    CHECK(found("a.####.png", 12345) == "a.12345.png");  // longer than its pad
    CHECK(found("b_###.png", 7) == "b_007.png");
    CHECK(found("c####.png", -1) == "c-001.png");
    CHECK(found("a.####.png", 8).empty());
}

TEST_CASE("sequences: a missing frame is told with the frames that are there") {
    const TempFolder folder;
    for (const int i : {1, 2, 3, 7, 9, 10}) touch(folder / ("a." + std::to_string(i) + ".png"));
    touch(folder / "a.x.png");
    touch(folder / "a.05.png");
    const AssetRules rules(folder.path(), false);
    const TextureFiles files = find_texture_files(rules, "a.<frame>.png", folder.path(), 5);
    CHECK(files.found.path.empty());
    CHECK(files.name == "a.5.png");
    CHECK(files.missing == "is missing (there are frames 1-3, 7, 9-10)");
    CHECK(find_texture_files(rules, "z.####.png", folder.path(), 5).missing ==
          "is missing, and so is every other frame");
}

TEST_CASE("sequences: a file whose name is what is written comes first") {
    const TempFolder folder;
    touch(folder / "wood#2.png");
    touch(folder / "100%d.png");
    touch(folder / "x<UDIM>.png");
    const AssetRules rules(folder.path(), false);
    for (const char* name : {"wood#2.png", "100%d.png", "x<UDIM>.png"})
        CHECK(stem(find_texture_files(rules, name, folder.path(), 1).found.path) == name);
    // What is no token is left alone: a missing file, not a missing frame.
    for (const char* name : {"a.%s.png", "a.<thing>.png", "a.%0444444d.png", "a.<F99>.png", "a.<"})
        CHECK(find_texture_files(rules, name, folder.path(), 1).missing.empty());
}

TEST_CASE("tiles: UDIM and UVTILE sets are found, in the order of their rows") {
    const TempFolder folder;
    for (const char* name :
         {"a.1002.png", "a.1001.png", "a.1011.png", "a.1000.png", "a.x.png", "a.10010.png",
          "b_u2_v1.png", "b_u1_v3.png", "b_u0_v1.png", "b_u_v.png"})
        touch(folder / name);
    const AssetRules rules(folder.path(), false);
    const auto places = [](const TextureFiles& files) {
        std::string text;
        for (const TextureTile& t : files.tiles)
            text +=
                std::to_string(t.column) + "," + std::to_string(t.row) + "=" + stem(t.file) + " ";
        return text;
    };
    const TextureFiles a = find_texture_files(rules, "a.<UDIM>.png", folder.path(), 1);
    CHECK(places(a) == "0,0=a.1001.png 1,0=a.1002.png 0,1=a.1011.png 9,900=a.10010.png ");
    CHECK(stem(a.found.path) == "a.<UDIM>.png");
    CHECK(places(find_texture_files(rules, "b_<UVTILE>.png", folder.path(), 1)) ==
          "1,0=b_u2_v1.png 0,2=b_u1_v3.png ");
    const TextureFiles none = find_texture_files(rules, "none.<UDIM>.png", folder.path(), 1);
    CHECK(none.tiles.empty());
    CHECK(none.missing == "has no tiles (looked for 'none.1001.png', 'none.1002.png', ... in " +
                              folder.path() + ")");
    CHECK(find_texture_files(rules, "n_<UVTILE>.png", folder.path(), 1)
              .missing.find("'n_u1_v1.png', 'n_u2_v1.png', ...") != std::string::npos);
}

TEST_CASE("tiles: a frame of a set is found, or told missing") {
    const TempFolder folder;
    for (const char* name : {"a.1001.0003.png", "a.1002.0003.png", "a.1001.0005.png"})
        touch(folder / name);
    const AssetRules rules(folder.path(), false);
    CHECK(find_texture_files(rules, "a.<UDIM>.####.png", folder.path(), 3).tiles.size() == 2);
    CHECK(find_texture_files(rules, "a.<UDIM>.####.png", folder.path(), 4).missing ==
          "is missing (there are frames 3, 5)");
}

TEST_CASE("tiles: none is taken from outside of the scene's folders") {
    const TempFolder folder;
    std::filesystem::create_directories(folder / "scene");
    touch(folder / "a.1001.png");
    const AssetRules rules(folder / "scene", false);
    CHECK(find_texture_files(rules, "../a.<UDIM>.png", folder / "scene", 1).tiles.empty());
    const AssetRules open(folder / "scene", true);
    CHECK(find_texture_files(open, "../a.<UDIM>.png", folder / "scene", 1).tiles.size() == 1);
}

TEST_CASE("tiles: a look-up reads the tile its place lies in, to the tile's very edge") {
    const TempFolder folder;
    TextureDesc set;
    set.file = "a.<UDIM>.tif";
    int value = 50;
    for (const auto& [column, row] : {std::pair{0, 0}, {1, 0}, {3, 0}, {0, 1}}) {
        const std::string path = folder / (std::to_string(value) + ".tif");
        write_tiff(path, 2, 2, 1, 0,
                   std::vector<std::uint8_t>(4, static_cast<std::uint8_t>(value)));
        set.tiles.push_back({column, row, path});
        value += 50;
    }
    for (const TextureFilter filter : kTextureFilters) {
        set.filter = filter;
        TestStore s;
        s.load({set});
        const auto at = [&](float u, float v) { return s->sample(0, u, v, 0)[0] * 255; };
        CHECK(at(0.5f, 0.5f) == doctest::Approx(50));
        CHECK(at(0.001f, 0.999f) == doctest::Approx(50));
        CHECK(at(0.9999f, 0.5f) == doctest::Approx(50));
        CHECK(at(1.0f, 0.5f) == doctest::Approx(100));
        CHECK(at(3.2f, 0.2f) == doctest::Approx(150));
        CHECK(at(0.2f, 1.9f) == doctest::Approx(200));
        const Texel magenta{1, 0, 1, 1};
        for (const auto& [u, v] : {std::pair{2.5f, 0.5f},
                                   {-0.1f, 0.5f},
                                   {1.5f, 1.5f},
                                   {0.5f, 2.0f},
                                   {9.5f, 0.5f},
                                   {1e30f, 0.5f},
                                   {0.5f, -1e30f}})
            CHECK(s->sample(0, u, v, 0.1f) == magenta);
        // One hole between tiles, told once; ends of rows are none.
        REQUIRE(s.problems.warnings().size() == 1);
        CHECK(s.problems.warnings()[0].find("1 tiles are missing") != std::string::npos);
        CHECK(s.problems.warnings()[0].find("u 2, v 0") != std::string::npos);
        CHECK(s->mean(0)[0] * 255 == doctest::Approx(125));
    }
}

TEST_CASE("tiles: a truncated one is damage; lenient, it alone is magenta") {
    const TempFolder folder;
    TextureDesc set;
    set.file = "a.<UDIM>.tif";
    for (int i = 0; i < 2; ++i) {
        const std::string path = folder / ("a.100" + std::to_string(i + 1) + ".tif");
        write_tiff(path, 64, 64, 1, 0, std::vector<std::uint8_t>(4096, 100));
        set.tiles.push_back({i, 0, path});
    }
    std::filesystem::resize_file(set.tiles[1].file, 1000);
    TestStore strict, lenient;
    strict.load({set});
    REQUIRE(strict.problems.errors().size() == 1);
    CHECK(strict.problems.errors()[0].find("a.1002.tif") != std::string::npos);
    lenient.problems = Problems(Strictness::lenient);
    lenient.load({set});
    CHECK(lenient->sample(0, 0.5f, 0.5f, 0)[1] * 255 == doctest::Approx(100));
    CHECK(lenient->sample(0, 1.5f, 0.5f, 0) == Texel{1, 0, 1, 1});
}
