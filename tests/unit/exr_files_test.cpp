#include <doctest/doctest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "renderer/api/image.h"
#include "renderer/image/check/exr_raw.h"
#include "renderer/image/exr_layers.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temp_folder.h"

using namespace tessera;

namespace {

namespace fs = std::filesystem;

constexpr PixelWindow kWindow{0, 0, 64, 48};

Layer make_layer(const std::string& name, std::vector<std::string> channels, LayerKind kind) {
    Layer layer{name, std::move(channels), kind, {}};
    std::uint32_t state = 3;
    for (std::size_t i = 0; i < 64 * 48 * layer.channels.size(); ++i) {
        state = state * 1664525u + 1013904223u;
        layer.pixels.push_back(static_cast<float>(state >> 8) * 0x1p-24f);
    }
    return layer;
}

LayeredImage make_picture(bool data = true) {
    LayeredImage image;
    image.width = 64;
    image.height = 48;
    image.window = kWindow;
    image.layers = {make_layer("", {"R", "G", "B", "A"}, LayerKind::color),
                    make_layer("albedo", {"R", "G", "B"}, LayerKind::color)};
    if (data) {
        image.layers.push_back(make_layer("", {"Z"}, LayerKind::data));
        image.layers.push_back(make_layer("N", {"X", "Y", "Z"}, LayerKind::data));
        for (const char* rank : {"CryptoObject00", "CryptoObject01"})
            image.layers.push_back(make_layer(rank, {"R", "G", "B", "A"}, LayerKind::data));
    }
    image.metadata = {{"tessera/spp", 4}};
    return image;
}

WriteOptions in(ExrLayout layout, ExrCompression codec = ExrCompression::zip) {
    WriteOptions options;
    options.layout = layout;
    options.compression = codec;
    return options;
}

std::string names(const RawPart& part) {
    std::string text;
    for (const RawChannel& c : part.channels) text += (text.empty() ? "" : " ") + c.name;
    return text;
}

const Layer& find_layer(const LayeredImage& image, const std::string& channel) {
    for (const Layer& layer : image.layers)
        if (layer.channels[0] == channel) return layer;
    FAIL("no channel " << channel);
    return image.layers[0];
}

ExitCode code_of(const LayeredImage& image, const std::string& path, const WriteOptions& options) {
    try {
        write_exr(image, path, options);
    } catch (const Error& error) {
        return error.code();
    }
    return ExitCode::done;
}

}  // namespace

TEST_CASE("exr files: every lossless codec brings all bits back") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    for (const ExrCompression codec :
         {ExrCompression::none, ExrCompression::zips, ExrCompression::zip, ExrCompression::piz}) {
        CAPTURE(static_cast<int>(codec));
        WriteOptions options = in(ExrLayout::single, codec);
        options.all_float = true;
        write_exr(image, folder / "a.exr", options);
        const LayeredImage back = read_exr(folder / "a.exr");
        CHECK(find_layer(back, "R").pixels == image.layers[0].pixels);
        CHECK(find_layer(back, "X").pixels == image.layers[3].pixels);
    }
}

TEST_CASE("exr files: depth of both kinds fits into one multi-part file") {
    LayeredImage image = make_picture();
    Layer filtered = find_layer(image, "Z");
    filtered.name = "depth";
    image.layers.push_back(filtered);
    const TempFolder folder;
    write_exr(image, folder / "a.exr", in(ExrLayout::multipart, ExrCompression::zip));
    const RawExr file = read_raw_exr(folder / "a.exr");
    REQUIRE(file.damage.empty());
    REQUIRE(file.parts.size() == 7);
    CHECK(names(file.parts[2]) == "Z.Z");
    CHECK(file.parts[2].name == "Z");
    CHECK(names(file.parts[6]) == "depth.Z");
}

TEST_CASE("exr files: layers are read back from many parts as from one") {
    const LayeredImage image = make_picture();
    const TempFolder folder;
    write_exr(image, folder / "one.exr", in(ExrLayout::single, ExrCompression::zip));
    write_exr(image, folder / "many.exr", in(ExrLayout::multipart, ExrCompression::zip));
    const LayeredImage one = read_exr(folder / "one.exr"), many = read_exr(folder / "many.exr");
    CHECK(many.window == one.window);
    CHECK(many.working_space == one.working_space);
    REQUIRE(many.layers.size() == one.layers.size());
    for (const Layer& layer : one.layers) {
        const std::string name =
            layer.name.empty() && layer.channels[0] == "Z" ? "depth" : layer.name;
        const auto same = std::find_if(many.layers.begin(), many.layers.end(),
                                       [&](const Layer& l) { return l.name == name; });
        REQUIRE(same != many.layers.end());
        CHECK(same->channels == layer.channels);
        CHECK(same->kind == layer.kind);
        CHECK(same->pixels == layer.pixels);
    }
}

TEST_CASE("exr files: a multi-part file has a part per layer and no bare names but beauty's") {
    const TempFolder folder;
    const WriteReport report =
        write_exr(make_picture(), folder / "a.exr", in(ExrLayout::multipart, ExrCompression::dwaa));
    CHECK(report.files == std::vector<std::string>{folder / "a.exr"});
    const RawExr file = read_raw_exr(folder / "a.exr");
    REQUIRE(file.damage.empty());
    REQUIRE(file.parts.size() == 6);
    CHECK(names(file.parts[0]) == "A B G R");
    CHECK(file.parts[0].name == "beauty");
    CHECK(file.parts[0].compression == 8);
    CHECK(names(file.parts[1]) == "albedo.B albedo.G albedo.R");
    CHECK(names(file.parts[2]) == "depth.Z");
    CHECK(file.parts[2].name == "depth");
    CHECK(names(file.parts[3]) == "N.X N.Y N.Z");
    for (std::size_t p = 2; p < 6; ++p) {
        CHECK(file.parts[p].compression == 3);  // data stays ZIP
        CHECK(file.parts[p].channels[0].type == ExrType::real);
        CHECK(file.parts[p].missing == 0);
    }
}

TEST_CASE("exr files: a split picture is a file per layer, ranks of a matte together") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    const WriteReport report = write_exr(image, folder / "a.exr", in(ExrLayout::split));
    CHECK(report.files == exr_files(image, folder / "a.exr", in(ExrLayout::split)));
    CHECK(report.files == std::vector<std::string>{folder / "a.exr", folder / "a.albedo.exr",
                                                   folder / "a.Z.exr", folder / "a.N.exr",
                                                   folder / "a.CryptoObject.exr"});
    std::uintmax_t bytes = 0;
    for (const std::string& path : report.files) bytes += fs::file_size(path);
    CHECK(report.bytes == bytes);
    CHECK(folder.count() == 5);
    const LayeredImage n = read_exr(folder / "a.N.exr");
    REQUIRE(n.layers.size() == 1);
    CHECK(n.layers[0].channels == std::vector<std::string>{"R", "G", "B"});
    CHECK(n.layers[0].pixels == image.layers[3].pixels);
    const RawExr matte = read_raw_exr(folder / "a.CryptoObject.exr");
    CHECK(matte.parts[0].channels.size() == 8);
    CHECK(matte.parts[0].channels[0].name == "CryptoObject00.A");
    CHECK(read_raw_exr(folder / "a.N.exr").parts[0].text("tessera/pass") == "N");
    CHECK(read_raw_exr(folder / "a.N.exr").parts[0].text("tessera/channels") == "X,Y,Z");
}

TEST_CASE("exr files: of a split picture only the mattes' file has their header") {
    const TempFolder folder;
    LayeredImage image = make_picture();
    for (const char* type : {"CryptoObject", "CryptoAsset"}) {
        const std::string prefix = std::string("cryptomatte/") + type[6] + "/";
        image.metadata.emplace_back(prefix + "name", type);
        image.metadata.emplace_back(prefix + "manifest", "{}");
    }
    write_exr(image, folder / "a.exr", in(ExrLayout::split));
    const RawExr beauty = read_raw_exr(folder / "a.exr");
    const RawExr matte = read_raw_exr(folder / "a.CryptoObject.exr");
    CHECK(beauty.parts[0].text("cryptomatte/O/name").empty());
    CHECK(beauty.parts[0].text("cryptomatte/O/manifest").empty());
    CHECK(matte.parts[0].text("cryptomatte/O/name") == "CryptoObject");
    CHECK(matte.parts[0].text("cryptomatte/O/manifest") == "{}");
    CHECK(matte.parts[0].text("cryptomatte/A/name").empty());
    // Parts share the first one's header.
    write_exr(image, folder / "b.exr", in(ExrLayout::multipart));
    CHECK(read_raw_exr(folder / "b.exr").parts[0].text("cryptomatte/O/name") == "CryptoObject");
}

TEST_CASE("exr files: a lone channel is luminance in a file of its own") {
    const TempFolder folder;
    LayeredImage image = make_picture(false);
    image.layers.push_back(make_layer("ao", {"A"}, LayerKind::data));
    write_exr(image, folder / "a.exr", in(ExrLayout::split));
    const RawExr ao = read_raw_exr(folder / "a.ao.exr");
    CHECK(names(ao.parts[0]) == "Y");
    CHECK(ao.parts[0].text("tessera/channels") == "A");
}

TEST_CASE("exr files: <aov> in the name stands for the pass, of split pictures only") {
    const TempFolder folder;
    const LayeredImage image = make_picture(false);
    const std::string path = folder / "<aov>/a.<aov>.exr";
    CHECK(exr_files(image, folder / "a_<aov>.exr", in(ExrLayout::split)) ==
          std::vector<std::string>{folder / "a_beauty.exr", folder / "a_albedo.exr"});
    CHECK(code_of(image, folder / "a_<aov>.exr", in(ExrLayout::single)) == ExitCode::usage);
    CHECK(folder.count() == 0);
}

TEST_CASE("exr files: a lossy codec is refused beside data in one part, and with float") {
    const TempFolder folder;
    const WriteOptions dwaa = in(ExrLayout::single, ExrCompression::dwaa);
    CHECK(code_of(make_picture(), folder / "a.exr", dwaa) == ExitCode::usage);
    CHECK(folder.count() == 0);
    CHECK(code_of(make_picture(false), folder / "a.exr", dwaa) == ExitCode::done);
    WriteOptions both = in(ExrLayout::split, ExrCompression::dwab);
    both.all_float = true;
    CHECK(code_of(make_picture(), folder / "b.exr", both) == ExitCode::usage);
}

TEST_CASE("exr files: no value that was clamped for a lossy codec comes back infinite") {
    const TempFolder folder;
    LayeredImage image = make_picture(false);
    for (std::size_t i = 0; i < image.layers[0].pixels.size(); i += 5)
        image.layers[0].pixels[i] = 1e9f;
    for (const float level : {0.0f, 45.0f, 1000.0f}) {
        CAPTURE(level);
        WriteOptions options = in(ExrLayout::single, ExrCompression::dwab);
        options.dwa_level = level;
        CHECK(write_exr(image, folder / "a.exr", options).clamped > 2000);
        const LayeredImage read = read_exr(folder / "a.exr");
        for (const float v : find_layer(read, "R").pixels) REQUIRE(std::isfinite(v));
    }
}

TEST_CASE("exr files: when one of a split picture's files fails, all old ones stay") {
    const TempFolder folder;
    const LayeredImage image = make_picture();
    const std::vector<std::string> paths = exr_files(image, folder / "a.exr", in(ExrLayout::split));
    for (const std::string& path : paths) std::ofstream(path) << "old";
    {
        const FileSizeLimit full(40000);  // beauty fits, the matte of 8 floats does not
        CHECK(code_of(image, folder / "a.exr", in(ExrLayout::split)) == ExitCode::output);
    }
    for (const std::string& path : paths) CHECK(contents(path) == "old");
    CHECK(folder.count() == paths.size());
    write_exr(image, folder / "a.exr", in(ExrLayout::split));
    CHECK(fs::file_size(paths[0]) < 40000);
    CHECK(fs::file_size(paths[4]) > 40000);
}

TEST_CASE("exr files: a full disk leaves the old multi-part file") {
    const TempFolder folder;
    std::ofstream(folder / "a.exr") << "old";
    for (const rlim_t limit : {100, 5000, 30000, 90000}) {
        CAPTURE(limit);
        const FileSizeLimit full(limit);
        CHECK(code_of(make_picture(), folder / "a.exr", in(ExrLayout::multipart)) ==
              ExitCode::output);
        CHECK(contents(folder / "a.exr") == "old");
        CHECK(folder.count() == 1);
    }
    CHECK(write_exr(make_picture(), folder / "a.exr", in(ExrLayout::multipart)).bytes > 90000);
}

TEST_CASE("reframe: what is outside is left out, what is missing is black and far away") {
    const LayeredImage image = make_picture();
    const LayeredImage out = reframe(image, {60, -2, 66, 3});
    CHECK(out.window == PixelWindow{60, -2, 66, 3});
    for (std::size_t l = 0; l < out.layers.size(); ++l) {
        const Layer &is = out.layers[l], &was = image.layers[l];
        const std::size_t n = is.channels.size();
        REQUIRE(is.pixels.size() == 6 * 5 * n);
        CHECK(is.pixels[2 * 6 * n] == was.pixels[60 * n]);                   // pixel 60,0
        CHECK(is.pixels[(4 * 6 + 3) * n] == was.pixels[(2 * 64 + 63) * n]);  // pixel 63,2
        const float empty = was.channels[0] == "Z" ? 1e10f : 0.0f;
        CHECK(is.pixels[0] == empty);                // above
        CHECK(is.pixels[(4 * 6 + 4) * n] == empty);  // to the right
    }
    CHECK(reframe(image, {100, 100, 102, 101}).layers[0].pixels == std::vector<float>(8));
}
