#include "renderer/image/image_io.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "renderer/api/image.h"
#include "tests/support/temp_folder.h"
#include "tests/support/tiff.h"

using namespace tessera;

namespace {

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void put(const std::string& path, const std::string& bytes) { write_anew(path, bytes); }

/// What read_image says of the file; "" if it reads. Any other exception fails the test.
std::string message_of(const std::string& path, const ImageLimits& limits = {}) {
    try {
        read_image(path, limits);
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::scene);
        CHECK(std::string(error.what()).find("image '" + path + "': cannot read: ") == 0);
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
        return error.what();
    }
    return "";
}

/// A beauty of the given size whose colour is (x, y, 0.5) over the window, alpha 0.
LayeredImage make_picture(int width, int height) {
    LayeredImage image;
    image.width = width;
    image.height = height;
    image.window = {0, 0, width, height};
    Layer layer{"", {"R", "G", "B", "A"}, LayerKind::color, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const float v : {static_cast<float>(x) / static_cast<float>(width),
                                  static_cast<float>(y) / static_cast<float>(height), 0.5f, 0.0f})
                layer.pixels.push_back(v);
    image.layers.push_back(layer);
    return image;
}

}  // namespace

TEST_CASE("image: bytes come as stored, rows from the top, alpha not multiplied in") {
    const TempFolder folder;
    const std::vector<std::uint8_t> values{255, 128, 0, 0,   10, 20, 30, 40,
                                           1,   2,   3, 128, 4,  5,  6,  255};
    write_tiff(folder / "a.tif", 2, 2, 4, 2, values);
    const ImageInfo info = image_info(folder / "a.tif");
    CHECK(info.width == 2);
    CHECK(info.height == 2);
    CHECK(info.channels == 4);
    CHECK(info.bits == 8);
    CHECK_FALSE(info.is_float);
    CHECK_FALSE(info.tiled);
    const Image image = read_image(folder / "a.tif");
    REQUIRE(image.pixels.size() == values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        CHECK(image.pixels[i] == doctest::Approx(values[i] / 255.0).epsilon(1e-6));
}

TEST_CASE("image: the content decides the format, not the name") {
    const TempFolder folder;
    write_tiff<std::uint16_t>(folder / "a.png", 1, 1, 1, 0, {32768});
    CHECK(image_info(folder / "a.png").bits == 16);
    CHECK(read_image(folder / "a.png").pixels[0] == doctest::Approx(32768.0 / 65535));
}

TEST_CASE("image: Radiance pictures are float") {
    const TempFolder folder;
    put(folder / "a.hdr", std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
                              std::string("\x80\x40\x20\x81\x80\x80\x80\x90", 8));
    CHECK(image_info(folder / "a.hdr").is_float);
    const Image image = read_image(folder / "a.hdr");
    REQUIRE(image.pixels.size() == 6);
    CHECK(image.pixels[0] == doctest::Approx(1).epsilon(0.01));  // 8-bit mantissa
    CHECK(image.pixels[1] == doctest::Approx(0.5).epsilon(0.02));
    CHECK(image.pixels[3] == doctest::Approx(32768).epsilon(0.01));
}

TEST_CASE("image: what is no picture is refused by its first bytes") {
    const TempFolder folder;
    put(folder / "empty.png", "");
    put(folder / "text.png", "hello, I am text");
    put(folder / "short.png", "\x89PN");
    CHECK(message_of(folder / "empty.png").find("empty") != std::string::npos);
    CHECK(message_of(folder / "text.png").find("not one of PNG") != std::string::npos);
    CHECK(message_of(folder / "short.png").find("not one of PNG") != std::string::npos);
    CHECK(message_of(folder / "none.png").find("No such file") != std::string::npos);
    CHECK(message_of(folder.path()).find("folder") != std::string::npos);
    CHECK(message_of("").find("No such file") != std::string::npos);
}

TEST_CASE("image: a pipe or a device is refused without waiting for it") {
    const TempFolder folder;
    REQUIRE(::mkfifo((folder / "pipe.png").c_str(), 0600) == 0);
    CHECK(message_of(folder / "pipe.png").find("not a regular file") != std::string::npos);
    CHECK(message_of("/dev/zero").find("not a regular file") != std::string::npos);
}

TEST_CASE("image: every truncation of every format is an error") {
    const TempFolder folder;
    const LayeredImage image = make_picture(33, 20);
    write_exr(image, folder / "a.exr");
    write_preview(image, folder / "a.png");
    write_preview(image, folder / "a.jpg");
    write_tiff(folder / "a.tif", 30, 20, 3, 0, std::vector<std::uint8_t>(1800, 77));
    put(folder / "a.hdr",
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 2\n" + std::string(24, '\x80'));
    for (const std::string name : {"a.exr", "a.png", "a.jpg", "a.tif", "a.hdr"}) {
        CAPTURE(name);
        const std::string whole = contents(folder / name);
        CHECK(message_of(folder / name).empty());
        // A TIFF of ours ends in 4 bytes that say there is no second picture: nothing is lost
        // there.
        const std::size_t tail = name == "a.tif" ? 4 : 0;
        const std::size_t last = whole.size() - tail - 1;
        for (std::size_t i = 0; i <= 40; ++i) {
            put(folder / "b", whole.substr(0, last * i / 40));
            CAPTURE(i);
            CHECK_FALSE(message_of(folder / "b").empty());
        }
    }
}

TEST_CASE("image: random damage gives pixels or an error, never a crash") {
    const TempFolder folder;
    const LayeredImage image = make_picture(33, 20);
    write_exr(image, folder / "a.exr");
    write_preview(image, folder / "a.jpg");
    write_tiff(folder / "a.tif", 30, 20, 3, 0, std::vector<std::uint8_t>(1800, 77));
    std::uint32_t state = 3;
    for (const char* name : {"a.exr", "a.jpg", "a.tif"}) {
        const std::string whole = contents(folder / name);
        for (int trial = 0; trial < 60; ++trial) {
            std::string bytes = whole;
            for (int k = 0; k < 4; ++k) {
                state = state * 1664525u + 1013904223u;
                bytes[4 + (state >> 8) % (bytes.size() - 4)] = static_cast<char>(state >> 3);
            }
            put(folder / "b", bytes);
            ImageLimits small;
            small.max_bytes = 64 << 20;
            message_of(folder / "b", small);
        }
    }
}

TEST_CASE("image: a size beyond the limits is refused before memory is taken") {
    const TempFolder folder;
    put(folder / "huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000000 +X 1000000000\n");
    CHECK(message_of(folder / "huge.hdr").find("more than the limit") != std::string::npos);
    put(folder / "zero.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 5\n");
    CHECK_FALSE(message_of(folder / "zero.hdr").empty());
    // Within the limits, but with no pixels to its claim: fails at once, without 3 GB of zeros.
    put(folder / "lie.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 16000 +X 16000\n");
    CHECK_FALSE(message_of(folder / "lie.hdr").empty());
    write_tiff(folder / "a.tif", 20, 10, 3, 0, std::vector<std::uint8_t>(600, 7));
    ImageLimits limits;
    limits.max_pixels = 199;
    CHECK_FALSE(message_of(folder / "a.tif", limits).empty());
    limits = {};
    limits.max_channels = 2;
    CHECK_FALSE(message_of(folder / "a.tif", limits).empty());
    limits = {};
    limits.max_bytes = 600;  // enough for the bytes of the file, not for its floats
    CHECK_NOTHROW(image_info(folder / "a.tif", limits));
    CHECK_FALSE(message_of(folder / "a.tif", limits).empty());
    CHECK(message_of(folder / "a.tif").empty());
}

TEST_CASE("preview: colours show over black though alpha is 0, through the sRGB curve") {
    const TempFolder folder;
    write_preview(make_picture(8, 4), folder / "a.png");
    const Image image = read_image(folder / "a.png");
    CHECK(image.width == 8);
    CHECK(image.height == 4);
    REQUIRE(image.channels == 3);
    // Linear 0.5 encodes to 0.7354, code 188.
    CHECK(image.pixels[2] == doctest::Approx(188 / 255.0).epsilon(1e-6));
    CHECK(image.pixels[0] == 0);
    CHECK(image.pixels[4 * 3] == doctest::Approx(188 / 255.0).epsilon(1e-6));  // x = 4 of 8
}

TEST_CASE("preview: JPEG by either extension, within its loss") {
    const TempFolder folder;
    for (const char* name : {"a.jpg", "b.JPEG"}) {
        write_preview(make_picture(16, 16), folder / name);
        const Image image = read_image(folder / name);
        REQUIRE(image.channels == 3);
        CHECK(image.pixels[2] == doctest::Approx(188 / 255.0).epsilon(0.05));
    }
}

TEST_CASE("preview: the failures are errors of the right kind and leave nothing") {
    const TempFolder folder;
    const auto code_of = [&](const LayeredImage& image, const std::string& path,
                             const std::string& view) {
        try {
            write_preview(image, path, view);
        } catch (const Error& error) {
            return error.code();
        }
        return ExitCode::done;
    };
    const LayeredImage image = make_picture(4, 4);
    CHECK(code_of(image, folder / "a.webp", "") == ExitCode::usage);
    CHECK(code_of(image, folder / "a", "") == ExitCode::usage);
    CHECK(code_of(image, folder / "a.png", "Nonsense") == ExitCode::usage);
    CHECK(code_of(image, folder / "no/a.png", "") == ExitCode::output);
    std::filesystem::create_directory(folder / "d.png");
    CHECK(code_of(image, folder / "d.png", "") == ExitCode::output);
    std::filesystem::remove(folder / "d.png");
    LayeredImage bare = image;
    bare.layers[0].name = "N";
    CHECK(code_of(bare, folder / "a.png", "") == ExitCode::output);
    CHECK(folder.count() == 0);
}
