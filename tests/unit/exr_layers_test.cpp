#include "renderer/image/exr_layers.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "renderer/image/image_io.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temp_folder.h"

using namespace tessera;

namespace {

Layer make_layer(const std::string& name, std::vector<std::string> channels, LayerKind kind,
                 const PixelWindow& w) {
    Layer layer{name, std::move(channels), kind, {}};
    const std::size_t count = static_cast<std::size_t>(w.width()) *
                              static_cast<std::size_t>(w.height()) * layer.channels.size();
    std::uint32_t state = 7;
    for (std::size_t i = 0; i < count; ++i) {
        state = state * 1664525u + 1013904223u;
        layer.pixels.push_back(static_cast<float>(state >> 8) * 0x1p-20f - 3.0f);
    }
    return layer;
}

/// Beauty, Z and N; a crop that starts inside the frame; more lines than one strip of the writer.
LayeredImage make_picture() {
    LayeredImage image;
    image.width = 40;
    image.height = 320;
    image.window = {5, 7, 36, 297};
    image.working_space = "acescg";
    image.layers = {make_layer("", {"R", "G", "B", "A"}, LayerKind::color, image.window),
                    make_layer("", {"Z"}, LayerKind::data, image.window),
                    make_layer("N", {"X", "Y", "Z"}, LayerKind::data, image.window)};
    image.metadata = {{"tessera/spp", 64}, {"tessera/seconds", 1.5f}, {"tessera/scene", "a b"}};
    return image;
}

const Layer& find_layer(const LayeredImage& image, const std::string& name,
                        const std::string& channel) {
    for (const Layer& layer : image.layers)
        if (layer.name == name && layer.channels[0] == channel) return layer;
    FAIL("no layer " << name << " with " << channel);
    return image.layers[0];
}

Error failure_of(const LayeredImage& image, const std::string& path) {
    try {
        write_exr(image, path);
    } catch (const Error& error) {
        return error;
    }
    return Error(ExitCode::done, "no error");
}

}  // namespace

TEST_CASE("exr: data layers, windows and metadata come back exactly") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    const WriteReport report = write_exr(image, folder / "a.exr");
    CHECK(report.non_finite == 0);
    CHECK(report.clamped == 0);
    CHECK(report.bytes == std::filesystem::file_size(folder / "a.exr"));

    const LayeredImage back = read_exr(folder / "a.exr");
    CHECK(back.width == image.width);
    CHECK(back.height == image.height);
    CHECK(back.window == image.window);
    CHECK(back.working_space == "acescg");
    REQUIRE(back.layers.size() == 3);
    CHECK(find_layer(back, "", "Z").pixels == image.layers[1].pixels);
    CHECK(find_layer(back, "N", "X").pixels == image.layers[2].pixels);
    CHECK(find_layer(back, "N", "X").channels == image.layers[2].channels);
    const std::map<std::string, MetadataValue> found(back.metadata.begin(), back.metadata.end());
    for (const auto& [name, value] : image.metadata) CHECK(found.at(name) == value);
}

TEST_CASE("exr: colour is stored as the nearest half") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    write_exr(image, folder / "a.exr");
    const Layer& was = image.layers[0];
    const LayeredImage back = read_exr(folder / "a.exr");
    const Layer& is = find_layer(back, "", "R");
    CHECK(is.kind == LayerKind::color);
    CHECK(is.channels == was.channels);
    REQUIRE(is.pixels.size() == was.pixels.size());
    for (std::size_t i = 0; i < was.pixels.size(); ++i)  // 11 bits: half a unit is 2^-11 relative
        REQUIRE(std::abs(is.pixels[i] - was.pixels[i]) <= std::abs(was.pixels[i]) * 0x1p-11f);
}

TEST_CASE("exr: all_float keeps colour exactly") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    WriteOptions options;
    options.all_float = true;
    write_exr(image, folder / "a.exr", options);
    const LayeredImage back = read_exr(folder / "a.exr");
    CHECK(find_layer(back, "", "R").pixels == image.layers[0].pixels);
    CHECK(find_layer(back, "", "Z").pixels == image.layers[1].pixels);
}

TEST_CASE("exr: what half cannot hold is clamped, what is no number becomes 0, both counted") {
    const TempFolder folder;
    LayeredImage image = make_picture();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    std::vector<float>& rgba = image.layers[0].pixels;
    rgba[0] = 1e6f;
    rgba[1] = -70000;
    rgba[2] = kInf;
    rgba[3] = std::nanf("");
    image.layers[1].pixels[0] = -kInf;
    image.layers[1].pixels[1] = 1e10f;
    const WriteReport report = write_exr(image, folder / "a.exr");
    CHECK(report.clamped == 2);
    CHECK(report.non_finite == 3);
    const LayeredImage back = read_exr(folder / "a.exr");
    const std::vector<float>& is = find_layer(back, "", "R").pixels;
    CHECK(is[0] == 65504);
    CHECK(is[1] == -65504);
    CHECK(is[2] == 0);
    CHECK(is[3] == 0);
    CHECK(find_layer(back, "", "Z").pixels[0] == 0);
    CHECK(find_layer(back, "", "Z").pixels[1] == 1e10f);
}

TEST_CASE("exr: the file has the same bytes for any number of threads") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    WriteOptions options;
    options.threads = 1;
    write_exr(image, folder / "1.exr", options);
    options.threads = 3;
    write_exr(image, folder / "3.exr", options);
    CHECK(contents(folder / "1.exr") == contents(folder / "3.exr"));
}

TEST_CASE("exr: a disk that fills up leaves the old file and no temporary") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    const std::string path = folder / "a.exr";
    std::ofstream(path) << "old";
    for (const rlim_t limit : {0, 100, 20000, 60000}) {
        CAPTURE(limit);
        const FileSizeLimit full(limit);
        const Error error = failure_of(image, path);
        CHECK(error.code() == ExitCode::output);
        CHECK(std::string(error.what()) == path + ": cannot write: File too large");
        CHECK(contents(path) == "old");
        CHECK(folder.count() == 1);
    }
    CHECK(write_exr(image, path).bytes > 60000);  // so each limit above bit
}

TEST_CASE("exr: a target that cannot be written is told by name") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    const Error missing = failure_of(image, folder / "no/a.exr");
    CHECK(missing.code() == ExitCode::output);
    CHECK(std::string(missing.what()).find("No such file or directory") != std::string::npos);
    const Error is_folder = failure_of(image, folder.path());
    CHECK(is_folder.code() == ExitCode::output);
    CHECK(std::string(is_folder.what()).find("it is a folder") != std::string::npos);
    CHECK(failure_of(image, "").code() == ExitCode::output);
    CHECK(failure_of(image, folder / "").code() == ExitCode::output);
    CHECK(failure_of(image, "/proc/a.exr").code() == ExitCode::output);
    std::ofstream(folder / "file") << "x";
    CHECK(failure_of(image, folder / "file/a.exr").code() == ExitCode::output);
    CHECK(folder.count() == 1);
}

TEST_CASE("exr: temporaries of dead processes go, those of living ones stay") {
    const TempFolder folder;
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    ::waitpid(child, nullptr, 0);  // its number is free now
    const std::string dead = folder / (".a.exr.tmp." + std::to_string(child));
    const std::string alive = folder / ".a.exr.tmp.1";
    const std::string other = folder / (".b.exr.tmp." + std::to_string(child));
    const std::string odd = folder / ".a.exr.tmp.12x";
    for (const std::string& path : {dead, alive, other, odd}) std::ofstream(path) << "part";
    write_exr(make_picture(), folder / "a.exr");
    CHECK_FALSE(std::filesystem::exists(dead));
    CHECK(std::filesystem::exists(alive));
    CHECK(std::filesystem::exists(other));
    CHECK(std::filesystem::exists(odd));
    CHECK(folder.count() == 4);
}

TEST_CASE("exr: a picture that breaks the contract is refused before a file exists") {
    const TempFolder folder;
    const auto code_after = [&](const auto& spoil) {
        LayeredImage image = make_picture();
        spoil(image);
        return failure_of(image, folder / "a.exr").code();
    };
    CHECK(code_after([](LayeredImage& i) { i.layers[2].name = std::string(30, 'n'); }) ==
          ExitCode::bug);
    CHECK(code_after([](LayeredImage& i) { i.metadata[0].first = std::string(32, 'n'); }) ==
          ExitCode::bug);
    CHECK(code_after([](LayeredImage& i) { i.metadata[0].first = "channels"; }) == ExitCode::bug);
    CHECK(code_after([](LayeredImage& i) { i.metadata[0].first = "tessera/seconds"; }) ==
          ExitCode::bug);
    CHECK(code_after([](LayeredImage& i) { i.layers.push_back(i.layers[2]); }) == ExitCode::bug);
    CHECK(code_after([](LayeredImage& i) { i.layers[2].pixels.pop_back(); }) == ExitCode::bug);
    CHECK(code_after([](LayeredImage& i) { i.window.x1 = i.window.x0; }) == ExitCode::bug);
    CHECK(code_after([](LayeredImage& i) { i.layers.clear(); }) == ExitCode::bug);
    CHECK(folder.count() == 0);
}

TEST_CASE("exr: a truncated or damaged file is an error, never a crash") {
    const TempFolder folder;
    write_exr(make_picture(), folder / "a.exr");
    const std::string whole = contents(folder / "a.exr");
    const auto code_of = [&](const std::string& bytes) {
        write_anew(folder / "b.exr", bytes);
        ImageLimits limits;
        limits.max_bytes = 16 << 20;
        try {
            read_exr(folder / "b.exr", limits);
        } catch (const Error& error) {
            return error.code();
        }
        return ExitCode::done;
    };
    CHECK(code_of(whole) == ExitCode::done);
    for (const std::size_t size : {std::size_t(0), std::size_t(3), std::size_t(9), std::size_t(200),
                                   whole.size() / 2, whole.size() - 1}) {
        CAPTURE(size);
        CHECK(code_of(whole.substr(0, size)) == ExitCode::scene);
    }
    std::uint32_t state = 1;
    for (int trial = 0; trial < 100; ++trial) {  // header and offset table: any outcome but a crash
        std::string bytes = whole;
        for (int k = 0; k < 3; ++k) {
            state = state * 1664525u + 1013904223u;
            bytes[4 + (state >> 8) % 700] = static_cast<char>(state >> 3);
        }
        const ExitCode code = code_of(bytes);
        const bool sane = code == ExitCode::done || code == ExitCode::scene;
        REQUIRE(sane);
    }
    CHECK_THROWS_AS(read_exr(folder / "missing.exr"), Error);
    CHECK_THROWS_AS(read_exr(folder.path()), Error);
}

TEST_CASE("exr: reading stops at the limits") {
    const TempFolder folder;
    write_exr(make_picture(), folder / "a.exr");
    ImageLimits limits;
    limits.max_pixels = 31 * 290 - 1;
    CHECK_THROWS_AS(read_exr(folder / "a.exr", limits), Error);
    limits.max_pixels += 1;
    CHECK_NOTHROW(read_exr(folder / "a.exr", limits));
}
