#include "renderer/image/colour_space.h"

#include <doctest/doctest.h>
#include <stdlib.h>

#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/image/ocio_config.h"
#include "tests/support/temp_folder.h"

using namespace tessera;

namespace {

/// $OCIO for one scope.
class OcioVariable {
public:
    explicit OcioVariable(const std::optional<std::string>& value) {
        if (const char* old = ::getenv("OCIO")) old_ = old;
        set(value);
    }
    ~OcioVariable() { set(old_); }

private:
    static void set(const std::optional<std::string>& value) {
        if (value)
            ::setenv("OCIO", value->c_str(), 1);
        else
            ::unsetenv("OCIO");
    }
    std::optional<std::string> old_;
};

std::array<float, 3> to_working(const ColorSpaces& colors, std::array<float, 3> rgb,
                                const std::string& from) {
    colors.to_working(rgb, from);
    return rgb;
}

std::string message_of(const ColorSpaces& colors, const std::string& from) {
    try {
        to_working(colors, {0, 0, 0}, from);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("colour: the sRGB curve equals OpenColorIO's, with OpenColorIO asleep") {
    const OcioVariable none(std::nullopt);
    const ColorSpaces colors("lin_rec709");
    const OcioConfig ocio("");
    for (int i = 0; i < 256; ++i) {
        const float code = static_cast<float>(i) / 255;
        std::array<float, 3> theirs{code, code, code};
        ocio.convert(theirs, "srgb_texture", "lin_rec709");
        const std::array<float, 3> ours = to_working(colors, {code, code, code}, "sRGB");
        // The toe of the standard has rounded constants, 7.7e-7 from the smooth join at most.
        const float tolerance = i <= 10 ? 1e-6f : 1e-6f * theirs[0] + 1e-7f;
        CHECK(std::abs(ours[0] - theirs[0]) <= tolerance);
        CHECK(ours[0] == srgb_to_linear(code));
    }
    CHECK(colors.is_plain_srgb("srgb_texture"));
    CHECK(colors.is_plain_srgb("sRGB - Texture"));
    CHECK_FALSE(colors.is_plain_srgb("raw"));
    CHECK_FALSE(colors.awake());
}

TEST_CASE("colour: the default view equals OpenColorIO's to half an 8-bit code, asleep") {
    const OcioVariable none(std::nullopt);
    const ColorSpaces colors("lin_rec709");
    const OcioConfig ocio("");
    for (int i = 0; i <= 300; ++i) {
        const float value = static_cast<float>(i) / 250;
        std::array<float, 3> theirs{value, value, value}, ours = theirs;
        ocio.display(theirs, "lin_rec709", "Standard");
        colors.to_display(ours, "");
        CHECK(std::abs(ours[1] - std::min(theirs[1], 1.0f)) <=
              1e-5f);  // the toe's constants, encoded
    }
    CHECK_FALSE(colors.awake());
    std::array<float, 3> odd{-1, std::nanf(""), HUGE_VALF};
    colors.to_display(odd, "Standard");
    CHECK(odd == std::array<float, 3>{0, 0, 1});
}

TEST_CASE("colour: the working space and data are left alone") {
    const OcioVariable none(std::nullopt);
    const ColorSpaces colors("acescg");
    for (const char* space : {"", "acescg", "ACEScg", "raw", "data", "Non-Color"})
        CHECK(to_working(colors, {0.1f, -2, 3}, space) == std::array<float, 3>{0.1f, -2, 3});
    CHECK_FALSE(colors.awake());
}

TEST_CASE("colour: white stays white between the working spaces, and primaries do not") {
    const OcioVariable none(std::nullopt);
    const ColorSpaces colors("acescg");
    for (const char* space : {"lin_rec709", "srgb_texture", "lin_rec2020", "aces2065_1"}) {
        CAPTURE(space);
        const std::array<float, 3> white = to_working(colors, {1, 1, 1}, space);
        for (const float v : white)
            CHECK(v == doctest::Approx(1).epsilon(1e-4));  // published digits
    }
    CHECK(colors.awake());
    // Rec.709 red in ACEScg by the Bradford-adapted matrix of the ACES project: 0.6131 0.0702
    // 0.0206
    const std::array<float, 3> red = to_working(colors, {1, 0, 0}, "lin_rec709");
    CHECK(red[0] == doctest::Approx(0.6131).epsilon(1e-3));
    CHECK(red[1] == doctest::Approx(0.0702).epsilon(1e-3));
    CHECK(red[2] == doctest::Approx(0.0206).epsilon(3e-3));
}

TEST_CASE("colour: Rec.2020 to Rec.709 follows the matrix of BT.2087") {
    const OcioVariable none(std::nullopt);
    const ColorSpaces colors("lin_rec709");
    // BT.2087 gives 709 to 2020 with four digits; its first column is Rec.709 red in Rec.2020.
    const std::array<float, 3> red = to_working(colors, {0.6274f, 0.0691f, 0.0164f}, "lin_rec2020");
    CHECK(red[0] == doctest::Approx(1).epsilon(1e-3));
    CHECK(std::abs(red[1]) < 2e-4f);
    CHECK(std::abs(red[2]) < 2e-4f);
}

TEST_CASE("colour: the ACES view compresses highlights that the standard view clips") {
    const OcioVariable none(std::nullopt);
    const ColorSpaces colors("lin_rec709");
    std::array<float, 3> two{2, 2, 2}, four{4, 4, 4};
    colors.to_display(two, "ACES");
    colors.to_display(four, "ACES");
    CHECK(two[1] < four[1]);
    CHECK(four[1] < 1);
    CHECK(two[1] > 0.8f);
    CHECK_THROWS_AS(colors.to_display(two, "Filmic"), Error);
}

TEST_CASE("colour: an unknown space names itself and its nearest neighbour") {
    const OcioVariable none(std::nullopt);
    const ColorSpaces colors("lin_rec709");
    CHECK(message_of(colors, "lin_rec202") ==
          "colour space 'lin_rec202': unknown (did you mean 'lin_rec2020'?)");
    CHECK(message_of(colors, "zzzzzzzzzzzzzz").find("'acescg'") != std::string::npos);
    CHECK(message_of(colors, std::string(100000, 'x')).find("unknown") != std::string::npos);
    CHECK_THROWS_AS(ColorSpaces("lin_rec2020"), Error);
    CHECK_THROWS_AS(ColorSpaces(""), Error);
}

TEST_CASE("colour: chromaticities are those of the working space") {
    const OcioVariable none(std::nullopt);
    CHECK(ColorSpaces("lin_rec709").chromaticities()[0] == 0.64f);
    CHECK(ColorSpaces("ACEScg").chromaticities()[0] == 0.713f);
}

TEST_CASE("colour: $OCIO replaces the built-in config") {
    const TempFolder folder;
    std::ofstream(folder / "c.ocio") << R"(ocio_profile_version: 1
strictparsing: false
roles: {scene_linear: Linear, default: Linear, data: Raw}
displays:
  mine: [!<View> {name: Only, colorspace: Half}]
active_displays: [mine]
active_views: [Only]
colorspaces:
  - !<ColorSpace> {name: Linear, family: "", bitdepth: 32f, isdata: false}
  - !<ColorSpace> {name: Raw, family: "", bitdepth: 32f, isdata: true}
  - !<ColorSpace>
      name: Half
      bitdepth: 32f
      to_reference: !<MatrixTransform> {matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]}
)";
    const OcioVariable mine(folder / "c.ocio");
    const ColorSpaces colors("lin_rec709");
    CHECK(to_working(colors, {0.25f, 0.25f, 0.25f}, "Half") ==
          std::array<float, 3>{0.5f, 0.5f, 0.5f});
    CHECK_FALSE(colors.is_plain_srgb("sRGB"));
    std::array<float, 3> shown{0.5f, 0.5f, 4};
    colors.to_display(shown, "");
    CHECK(shown == std::array<float, 3>{0.25f, 0.25f, 1});
    CHECK(message_of(colors, "acescg").find("unknown") != std::string::npos);
}

TEST_CASE("colour: a config that cannot be read is an error that names it") {
    const TempFolder folder;
    std::ofstream(folder / "bad.ocio") << "ocio_profile_version: [";
    for (const char* name : {"bad.ocio", "missing.ocio"}) {
        const OcioVariable bad(folder / name);
        try {
            const ColorSpaces colors("lin_rec709");
            FAIL("no error");
        } catch (const Error& error) {
            CHECK(error.code() == ExitCode::scene);
            CHECK(std::string(error.what()).find(name) != std::string::npos);
        }
    }
}
