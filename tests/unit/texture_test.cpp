#include "renderer/image/texture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "renderer/api/image.h"
#include "renderer/core/parallel.h"
#include "renderer/image/colour_space.h"
#include "tests/support/temp_folder.h"
#include "tests/support/tiff.h"

using namespace tessera;

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr float kInf = std::numeric_limits<float>::infinity();

/// A store with one texture per description, all for the same use.
struct Fixture {
    ColorSpaces colors{"lin_rec709"};
    Problems problems;
    std::unique_ptr<TextureStore> store;

    void load(const std::vector<TextureDesc>& descs, TextureUse use = TextureUse::data,
              Workers* workers = nullptr) {
        std::vector<TextureRequest> requests;
        for (const TextureDesc& desc : descs) requests.push_back({&desc, use});
        store = std::make_unique<TextureStore>(requests, colors, problems, workers);
    }
};

TextureDesc from_file(const std::string& file, Wrap wrap = Wrap::repeat) {
    TextureDesc desc;
    desc.file = file;
    desc.wrap_u = desc.wrap_v = wrap;
    return desc;
}

void check_texel(const Texel& is, const Texel& wanted, float tolerance = 1e-6f) {
    for (std::size_t c = 0; c < 4; ++c) CHECK(std::abs(is[c] - wanted[c]) <= tolerance);
}

/// A float picture of R, G, B from a function of the texel.
template <class F>
void write_rgb_exr(const std::string& path, int width, int height, const F& value) {
    LayeredImage image;
    image.width = width;
    image.height = height;
    image.window = {0, 0, width, height};
    Layer layer{"", {"R", "G", "B"}, LayerKind::data, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) layer.pixels.push_back(value(x, y, c));
    image.layers.push_back(layer);
    write_exr(image, path);
}

std::uint8_t noise(std::size_t i) {
    std::uint32_t h = static_cast<std::uint32_t>(i) * 2654435761u;
    h ^= h >> 15;
    return static_cast<std::uint8_t>(h * 2246822519u >> 24);
}

}  // namespace

TEST_CASE("texture: v points up, row 0 is the top, texel centres lie at (i + 0.5) / n") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 2, 2, 3, 0, Bytes{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255});
    Fixture f;
    f.load({from_file(folder / "a.tif", Wrap::clamp)});
    check_texel(f.store->sample(0, 0.25f, 0.75f, 0), {1, 0, 0, 1});
    check_texel(f.store->sample(0, 0.75f, 0.75f, 0), {0, 1, 0, 1});
    check_texel(f.store->sample(0, 0.25f, 0.25f, 0), {0, 0, 1, 1});
    check_texel(f.store->sample(0, 0.75f, 0.25f, 0), {1, 1, 1, 1});
    check_texel(f.store->sample(0, 0.5f, 0.5f, 0), {0.5f, 0.5f, 0.5f, 1});
    check_texel(f.store->sample(0, 0.5f, 0.75f, 0), {0.5f, 0.5f, 0, 1});
    check_texel(f.store->sample(0, 0, 1, 0), {1, 0, 0, 1});
}

TEST_CASE("texture: each wrap mode reads the texels it should beyond the border") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 2, 1, 1, 0, Bytes{0, 255});  // dark left, bright right
    Fixture f;
    f.load({from_file(folder / "a.tif", Wrap::repeat), from_file(folder / "a.tif", Wrap::clamp),
            from_file(folder / "a.tif", Wrap::mirror), from_file(folder / "a.tif", Wrap::black)});
    const auto at = [&](int texture, float u) { return f.store->sample(texture, u, 0.5f, 0)[0]; };
    CHECK(at(0, 0) == doctest::Approx(0.5));  // the seam is interpolated across
    CHECK(at(0, -0.25f) == doctest::Approx(1));
    CHECK(at(0, 5.25f) == doctest::Approx(0).epsilon(1e-5));
    CHECK(at(1, -7) == 0);
    CHECK(at(1, 7) == 1);
    CHECK(at(2, 1) == doctest::Approx(1));
    CHECK(at(2, 1.25f) == doctest::Approx(1));
    CHECK(at(2, 1.75f) == doctest::Approx(0));
    CHECK(at(2, -0.75f) == doctest::Approx(1));
    CHECK(at(2, 2) == doctest::Approx(0));
    CHECK(at(3, 1) == doctest::Approx(0.5));  // half way out of the last texel
    CHECK(at(3, 1.25f) == 0);
    CHECK(at(3, -100) == 0);
}

TEST_CASE("texture: the seam of a repeating picture is continuous at every level") {
    const TempFolder folder;
    Bytes values;
    for (std::size_t i = 0; i < 37 * 21; ++i) values.push_back(noise(i));
    write_tiff(folder / "a.tif", 37, 21, 1, 0, values);
    Fixture f;
    f.load({from_file(folder / "a.tif", Wrap::repeat), from_file(folder / "a.tif", Wrap::mirror)});
    for (int t = 0; t < 2; ++t)
        for (const float width : {0.0f, 0.06f, 0.3f, 1.0f})
            for (float v = 0.03f; v < 2; v += 0.11f) {
                // Slope is at most 37 a unit of u: 2e-5 apart is 7.4e-4.
                CHECK(std::abs(f.store->sample(t, 1 - 1e-5f, v, width)[0] -
                               f.store->sample(t, 1 + 1e-5f, v, width)[0]) < 8e-4f);
                CHECK(std::abs(f.store->sample(t, v, 1 - 1e-5f, width)[0] -
                               f.store->sample(t, v, 1 + 1e-5f, width)[0]) < 8e-4f);
            }
}

TEST_CASE("texture: colour bytes are decoded by the sRGB curve, data bytes are not") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 1, 1, 4, 2, Bytes{188, 10, 255, 188});
    Fixture f;
    f.load({from_file(folder / "a.tif")}, TextureUse::color);
    check_texel(f.store->sample(0, 0.5f, 0.5f, 0),
                {srgb_to_linear(188 / 255.0f), srgb_to_linear(10 / 255.0f), 1, 188 / 255.0f});
    f.load({from_file(folder / "a.tif")}, TextureUse::data);
    check_texel(f.store->sample(0, 0.5f, 0.5f, 0), {188 / 255.0f, 10 / 255.0f, 1, 188 / 255.0f});
    TextureDesc raw = from_file(folder / "a.tif");
    raw.color_space = "raw";
    f.load({raw}, TextureUse::color);
    check_texel(f.store->sample(0, 0.5f, 0.5f, 0), {188 / 255.0f, 10 / 255.0f, 1, 188 / 255.0f});
    CHECK_FALSE(f.colors.awake());
}

TEST_CASE("texture: mip levels are means of light, not of codes") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 2, 1, 1, 0, Bytes{0, 255});
    Fixture f;
    f.load({from_file(folder / "a.tif")}, TextureUse::color);
    // The mean of black and white is 0.5; the nearest 8-bit code is within 0.5 / 255 * slope 2.
    CHECK(std::abs(f.store->sample(0, 0.3f, 0.3f, 1)[0] - 0.5f) < 0.004f);
    CHECK(f.store->mean(0)[0] == doctest::Approx(0.5));
}

TEST_CASE("texture: the coarsest level is the mean, whatever the size") {
    const TempFolder folder;
    for (const auto& size : {std::pair{64, 64}, {37, 21}, {1, 65}, {100, 3}, {5, 1}, {1, 1}}) {
        const int w = size.first, h = size.second;
        CAPTURE(w);
        CAPTURE(h);
        std::vector<std::uint16_t> values;
        for (std::size_t i = 0; i < static_cast<std::size_t>(w * h); ++i)
            values.push_back(static_cast<std::uint16_t>(noise(i) * 257));
        write_tiff(folder / "a.tif", w, h, 1, 0, values);
        Fixture f;
        f.load({from_file(folder / "a.tif")});
        double sum = 0;
        for (const std::uint16_t v : values) sum += v / 65535.0;
        const auto mean = static_cast<float>(sum / (w * h));
        CHECK(std::abs(f.store->mean(0)[0] - mean) < 1e-5f);
        CHECK(std::abs(f.store->sample(0, 0.1f, 0.7f, 1000)[0] - mean) < 2e-5f);  // 16-bit codes
    }
}

TEST_CASE("texture: the level follows the footprint and blends between levels") {
    const TempFolder folder;
    // A checkerboard of single texels: contrast is full at level 0 and gone at level 1.
    write_rgb_exr(folder / "a.exr", 16, 16,
                  [](int x, int y, int) { return (x + y) % 2 ? 1.0f : 0.0f; });
    Fixture f;
    f.load({from_file(folder / "a.exr")});
    const float u = 0.5f / 16, v = 1 - 0.5f / 16;  // the centre of a black texel
    CHECK(f.store->sample(0, u, v, 0)[0] == 0);
    CHECK(f.store->sample(0, u, v, 1 / 16.0f)[0] == 0);
    CHECK(f.store->sample(0, u, v, std::sqrt(2.0f) / 16)[0] == doctest::Approx(0.25));
    CHECK(f.store->sample(0, u, v, 2 / 16.0f)[0] == doctest::Approx(0.5));
    CHECK(f.store->sample(0, u, v, 0.7f)[0] == doctest::Approx(0.5));
}

TEST_CASE("texture: colour that cannot be seen does not bleed into coarse levels") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 2, 1, 4, 2, Bytes{255, 0, 0, 255, 0, 255, 0, 0});
    Fixture f;
    f.load({from_file(folder / "a.tif")});
    check_texel(f.store->sample(0, 0.5f, 0.5f, 2), {1, 0, 0, 0.5f}, 0.005f);  // 8-bit codes
    CHECK(f.store->has_alpha(0));
    CHECK_FALSE(f.store->channel_is_one(0, 3));
    CHECK(f.store->mean(0)[3] == doctest::Approx(0.5));
}

TEST_CASE("texture: channels a file lacks are filled in") {
    const TempFolder folder;
    write_tiff(folder / "l.tif", 1, 1, 1, 0, Bytes{51});
    write_tiff(folder / "la.tif", 1, 1, 2, 2, Bytes{51, 102});
    write_tiff(folder / "rgb.tif", 1, 1, 3, 0, Bytes{51, 102, 255});
    write_tiff(folder / "rgba.tif", 1, 1, 4, 2, Bytes{51, 102, 153, 255});
    Fixture f;
    f.load({from_file(folder / "l.tif"), from_file(folder / "la.tif"),
            from_file(folder / "rgb.tif"), from_file(folder / "rgba.tif")});
    check_texel(f.store->sample(0, 0, 0, 0), {0.2f, 0.2f, 0.2f, 1});
    check_texel(f.store->sample(1, 0, 0, 0), {0.2f, 0.2f, 0.2f, 0.4f});
    check_texel(f.store->sample(2, 0, 0, 0), {0.2f, 0.4f, 1, 1});
    check_texel(f.store->sample(3, 0, 0, 0), {0.2f, 0.4f, 0.6f, 1});
    CHECK_FALSE(f.store->has_alpha(0));
    CHECK(f.store->has_alpha(1));
    CHECK_FALSE(f.store->has_alpha(2));
    CHECK(f.store->channel_is_one(2, 3));
    CHECK(f.store->channel_is_one(2, 2));
    CHECK_FALSE(f.store->channel_is_one(2, 1));
    CHECK(f.store->channel_is_one(3, 3));
    CHECK_FALSE(f.store->channel_is_one(1, 3));
}

TEST_CASE("texture: placement, gain and bias") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 2, 1, 1, 0, Bytes{51, 204});
    TextureDesc desc = from_file(folder / "a.tif");
    desc.scale = {2, 1};
    desc.offset = {0.5f, 0};
    desc.gain = 2;
    desc.bias = -0.1f;
    Fixture f;
    f.load({desc});
    // u = 0.125: 0.125 * 2 + 0.5 = 0.75, the bright texel: 0.8 * 2 - 0.1; alpha is not graded.
    check_texel(f.store->sample(0, 0.125f, 0.5f, 0), {1.5f, 1.5f, 1.5f, 1});
    CHECK(f.store->mean(0)[0] == doctest::Approx(0.9));
    CHECK(f.store->mean(0)[3] == 1);
}

TEST_CASE("texture: any input gives finite values") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 3, 2, 3, 0, Bytes(18, 100));
    const float nan = std::nanf("");
    std::vector<TextureDesc> descs;
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::black}) {
        descs.push_back(from_file(folder / "a.tif", wrap));
        descs.push_back(descs.back());
        descs.back().scale = {1e30f, nan};
        descs.back().gain = 3e38f;
        descs.back().bias = kInf;
    }
    Fixture f;
    f.load(descs);
    for (int t = 0; t < f.store->size(); ++t)
        for (const float u : {0.0f, nan, kInf, -kInf, 1e30f, -1e30f, 3e38f, -1e-30f, 16777217.0f})
            for (const float width : {0.0f, -1.0f, nan, kInf, 1e30f})
                for (const Texel& texel :
                     {f.store->sample(t, u, 0.3f, width), f.store->sample(t, 0.3f, u, width)})
                    for (const float v : texel) CHECK(std::isfinite(v));
    check_texel(f.store->sample(0, nan, kInf, 0), f.store->sample(0, 0, 0, 0));
}

TEST_CASE("texture: half floats keep range, values that are no number become 0 and are counted") {
    const TempFolder folder;
    const std::string path = folder / "a.exr";
    write_rgb_exr(path, 2, 1,
                  [](int x, int, int c) { return x == 0 ? 1e5f : (c == 0 ? 7 : 0.1f); });
    Fixture f;
    f.load({from_file(path, Wrap::clamp)});
    check_texel(f.store->sample(0, 0.25f, 0, 0), {65504, 65504, 65504, 1});
    check_texel(f.store->sample(0, 0.75f, 0, 0), {7, 0.1f, 0.1f, 1}, 3e-5f);  // 11 bits
    REQUIRE(f.problems.warnings().size() == 1);
    CHECK(f.problems.warnings()[0].find("3 values are beyond 65504") != std::string::npos);
}

TEST_CASE("texture: an unreadable file is one warning and magenta") {
    const TempFolder folder;
    Fixture f;
    f.load({from_file(folder / "none.png"), from_file(folder / "none.png"),
            from_file(folder / "none.png", Wrap::clamp)});
    CHECK(f.problems.warnings().size() == 1);
    CHECK(f.problems.warnings()[0].find("none.png") != std::string::npos);
    for (int t = 0; t < 3; ++t) check_texel(f.store->sample(t, 0.3f, 9, 0.5f), {1, 0, 1, 1});
    CHECK_FALSE(f.store->has_alpha(0));
    Fixture strict;
    strict.problems = Problems(Strictness::strict);
    strict.load({from_file(folder / "none.png")});
    CHECK(strict.problems.errors().size() == 1);
}

TEST_CASE("texture: an unknown colour space is an error at its place") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 1, 1, 1, 0, Bytes{51});
    TextureDesc desc = from_file(folder / "a.tif");
    desc.color_space = "acesgc";
    desc.loc = {std::make_shared<const std::string>("s.toml"), 3, 4};
    Fixture f;
    f.load({desc});
    REQUIRE(f.problems.errors().size() == 1);
    CHECK(f.problems.errors()[0] ==
          "s.toml:3:4: colour space 'acesgc': unknown (did you mean 'acescg'?)");
}

TEST_CASE("texture: other colour spaces are converted, and grey stays one channel") {
    const TempFolder folder;
    write_tiff(folder / "rgb.tif", 8, 8, 3, 0, Bytes(192, 255));
    write_tiff(folder / "l.tif", 8, 8, 1, 0, Bytes(64, 188));
    TextureDesc rgb = from_file(folder / "rgb.tif"), grey = from_file(folder / "l.tif");
    rgb.color_space = "acescg";
    grey.color_space = "acescg";
    Fixture f;
    f.load({rgb, grey}, TextureUse::color);
    check_texel(f.store->sample(0, 0, 0, 0), {1, 1, 1, 1}, 1e-3f);  // half, published digits
    const float wanted = 188 / 255.0f;
    check_texel(f.store->sample(1, 0, 0, 0), {wanted, wanted, wanted, 1}, 1e-3f);
    CHECK(f.colors.awake());
}

TEST_CASE("texture: equal files share memory, other colour spaces do not") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 64, 64, 3, 0, Bytes(64 * 64 * 3, 9));
    Fixture one, two, three;
    const TextureDesc desc = from_file(folder / "a.tif");
    TextureDesc moved = desc, other = desc;
    moved.offset = {0.5f, 0};
    other.color_space = "sRGB";
    one.load({desc});
    two.load({desc, moved, desc});
    three.load({desc, other});
    CHECK(one.store->memory_bytes() > 64 * 64 * 3);
    CHECK(one.store->memory_bytes() < 2 * 64 * 64 * 3);
    CHECK(two.store->memory_bytes() == one.store->memory_bytes());
    CHECK(three.store->memory_bytes() == 2 * one.store->memory_bytes());
}

TEST_CASE("texture: loading by many threads gives the same values and messages") {
    const TempFolder folder;
    std::vector<TextureDesc> descs;
    for (int i = 0; i < 12; ++i) {
        const std::string path = folder / (std::to_string(i) + ".tif");
        Bytes values;
        for (std::size_t k = 0; k < 300; ++k)
            values.push_back(noise(k + static_cast<std::size_t>(i)));
        if (i % 5 != 4) write_tiff(path, 10, 10, 3, 0, values);
        descs.push_back(from_file(path));
    }
    Workers workers(2);
    Fixture one, many;
    one.load(descs, TextureUse::color);
    many.load(descs, TextureUse::color, &workers);
    CHECK(one.problems.warnings() == many.problems.warnings());
    CHECK(one.problems.warnings().size() == 2);
    for (int t = 0; t < 12; ++t)
        CHECK(one.store->sample(t, 0.33f, 0.71f, 0.2f) ==
              many.store->sample(t, 0.33f, 0.71f, 0.2f));
}
