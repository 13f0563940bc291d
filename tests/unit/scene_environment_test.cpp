#include <doctest/doctest.h>

#include <cmath>

#include "renderer/core/vec.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scenes.h"
#include "tests/support/tiff.h"

namespace tessera::test {
namespace {

// What a small camera at the origin sees along d under the environment written as `text`.
Color seen(const SceneFolder& folder, const std::string& text, Double3 d) {
    SceneDesc scene = folder.load(text);
    look(scene, {0, 0, 0}, d, 0.5);
    set_film(scene, 4, 4, 16);
    const auto pixels = beauty_of(std::move(scene));
    return {pixels[0], pixels[1], pixels[2]};
}

// Squares in a picture, each of one red value.
void write_cells(const std::string& path, int columns, int rows, const std::vector<int>& red) {
    constexpr int kSide = 8;
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < rows * kSide; ++y)
        for (int x = 0; x < columns * kSide; ++x) {
            const int r = red[static_cast<std::size_t>(y / kSide * columns + x / kSide)];
            texels.insert(texels.end(), {static_cast<std::uint8_t>(r), 0, 0});
        }
    write_tiff<std::uint8_t>(path, columns * kSide, rows * kSide, 3, 0, texels);
}

float red_of(int value) { return static_cast<float>(value) / 255; }

}  // namespace

TEST_CASE("environment: a cross is known by its shape and shows each face where it lies") {
    const SceneFolder folder;
    // +y above, -x -z +x +z in the row, -y below.
    write_cells(folder.path("cross.tif"), 4, 3, {0, 10, 0, 0, 20, 30, 40, 50, 0, 60, 0, 0});
    const std::string text = "[environment]\nfile = 'cross.tif'\ncolor_space = 'raw'\n";
    CHECK(seen(folder, text, {0, 0, -1}).x == doctest::Approx(red_of(30)).epsilon(0.02));
    CHECK(seen(folder, text, {1, 0, 0}).x == doctest::Approx(red_of(40)).epsilon(0.02));
    CHECK(seen(folder, text, {-1, 0, 0}).x == doctest::Approx(red_of(20)).epsilon(0.02));
    CHECK(seen(folder, text, {0, 0, 1}).x == doctest::Approx(red_of(50)).epsilon(0.02));
    CHECK(seen(folder, text, {0, 1, 0}).x == doctest::Approx(red_of(10)).epsilon(0.02));
    CHECK(seen(folder, text, {0, -1, 0}).x == doctest::Approx(red_of(60)).epsilon(0.02));
}

TEST_CASE("environment: six faces are those of the axes") {
    const SceneFolder folder;
    std::string faces;
    for (int i = 0; i < 6; ++i) {
        const std::string name = "f" + std::to_string(i) + ".tif";
        write_cells(folder.path(name), 1, 1, {10 * (i + 1)});
        faces += (i ? ", '" : "'") + name + "'";
    }
    const std::string text = "[environment]\nfaces = [" + faces + "]\ncolor_space = 'raw'\n";
    CHECK(seen(folder, text, {1, 0, 0}).x == doctest::Approx(red_of(10)).epsilon(0.02));
    CHECK(seen(folder, text, {0, -1, 0}).x == doctest::Approx(red_of(40)).epsilon(0.02));
    CHECK(seen(folder, text, {0, 0, -1}).x == doctest::Approx(red_of(60)).epsilon(0.02));
}

TEST_CASE(
    "environment: a square is asked about, a wrong shape refused, faces are six of one size") {
    const SceneFolder folder;
    write_cells(folder.path("square.tif"), 1, 1, {50});
    write_cells(folder.path("wide.tif"), 2, 1, {50, 60});
    const auto failure = [&](const std::string& text) {
        try {
            SceneDesc scene = folder.load("[environment]\n" + text);
            build_scene(std::move(scene));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(failure("file = 'square.tif'").find("mirror ball or an angular map") !=
          std::string::npos);
    CHECK(failure("file = 'square.tif'\nprojection = 'angular'") == "");
    CHECK(failure("file = 'wide.tif'\nprojection = 'angular'").find("not the shape") !=
          std::string::npos);
    CHECK(failure("faces = ['wide.tif']").find("faces are six images") != std::string::npos);
    const std::string one = "'square.tif', ";
    CHECK(failure("faces = [" + one + one + one + one + one + "'wide.tif']")
              .find("squares of one size") != std::string::npos);
}

TEST_CASE("environment: an image that is wrong is told by its key, at its place") {
    const SceneFolder folder;
    write_cells(folder.path("wide.tif"), 2, 1, {50, 60});
    write_cells(folder.path("square.tif"), 1, 1, {50});
    folder.write("broken.tif", "II*");
    const auto says = [&](const std::string& text, const std::string& what) {
        std::string message;
        try {
            build_scene(folder.load("[environment]\n" + text));
        } catch (const Error& error) {
            message = error.what();
        }
        CAPTURE(message);
        CHECK(message.find(what) != std::string::npos);
    };
    for (const std::string key : {"file", "camera", "lighting", "reflection"}) {
        const std::string place = "/s.toml:3:1: environment: " + key;
        says(key + " = 'gone.tif'", place + " 'gone.tif' not found");
        says(key + " = 'broken.tif'", place + ": image '" + folder.path("broken.tif") + "'");
        says(key + " = 'wide.tif'\nprojection = 'angular'",
             place + " '" + folder.path("wide.tif") + "': 16x8 pixels");
    }
    std::string faces = "faces = [";
    for (int i = 0; i < 5; ++i) faces += "'square.tif', ";
    says("rotate_deg = 1\n" + faces + "'wide.tif']",
         "/s.toml:4:1: environment: faces '" + folder.path("wide.tif") + "'");
}

TEST_CASE("sky: the sun stands where it is put, or where place and time say") {
    const SceneFolder folder;
    const std::string low = "[sky]\nsun_elevation_deg = 20\nsun_azimuth_deg = 90\n";
    const Color sun = seen(folder, low, {std::cos(0.349), std::sin(0.349), 0});
    const Color away = seen(folder, low, {-std::cos(0.349), std::sin(0.349), 0});
    CHECK(sun.y > 1000 * away.y);
    CHECK(away.y > 0);
    // Noon of the solstice at the tropic: overhead.
    const std::string noon =
        "[sky]\nlatitude_deg = 23.44\nlongitude_deg = 0\ntime = '2026-06-21T12:02Z'\n";
    SceneDesc scene = folder.load(noon);
    REQUIRE(scene.sky->when);
    CHECK(seen(folder, noon, {0, 1, 0}).y > 1000 * seen(folder, noon, {1, 0.2, 0}).y);
    CHECK(seen(folder, low + "sun = false\n", {std::cos(0.349), std::sin(0.349), 0}).y <
          0.1f * sun.y);
}

TEST_CASE("sky: what contradicts itself is an error at its place") {
    const SceneFolder folder;
    CHECK(folder.failure("[sky]\ntime = 'noon'").find("s.toml:3:1: sky: time is 'noon'") !=
          std::string::npos);
    CHECK(folder.failure("[sky]\ntime = '2026-06-21T12:00Z'").find("needs latitude_deg") !=
          std::string::npos);
    for (const char* day : {"2026-02-30", "2026-06-31", "2025-02-29", "1900-02-29"}) {
        const std::string sky =
            std::string("[sky]\nlatitude_deg = 1\nlongitude_deg = 1\ntime = '") + day +
            "T12:00Z'\n";
        CHECK(folder.failure(sky).find("s.toml:5:1: sky: time is '" + std::string(day) +
                                       "T12:00Z', a day that there is not") != std::string::npos);
    }
    const char* const leap =
        "[sky]\nlatitude_deg = 1\nlongitude_deg = 1\ntime = '2024-02-29T12:00Z'\n";
    CHECK(folder.load(leap).sky->when->day == 29);
    CHECK(folder.failure("[sky]\nlatitude_deg = 3").find("need a time") != std::string::npos);
    CHECK(folder
              .failure("[sky]\ntime = '2026-06-21T12:00Z'\nlatitude_deg = 1\nlongitude_deg = 1\n"
                       "sun_azimuth_deg = 3")
              .find("both say where the sun is") != std::string::npos);
    CHECK(folder.failure("[sky]\n[environment]\n").find("there is an [environment] already") !=
          std::string::npos);
    CHECK(folder.failure("[sky]\nturbidity = 1").find("turbidity is 1") != std::string::npos);
}

}  // namespace tessera::test
