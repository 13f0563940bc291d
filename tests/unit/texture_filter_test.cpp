// What each filter makes of known texels, by formulas written down again in doubles.

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>

#include "renderer/image/tx_file.h"
#include "tests/support/temp_folder.h"
#include "tests/support/texture_stores.h"

using namespace tessera;

namespace {

constexpr int kW = 7, kH = 5;

/// One line of texels continued without end, the wrap taken at its word; 0 outside of black.
int place_in(int i, int n, Wrap wrap) {
    switch (wrap) {
        case Wrap::repeat:
            while (i < 0) i += n;
            return i % n;
        case Wrap::clamp:
            return std::min(std::max(i, 0), n - 1);
        case Wrap::mirror:
            while (i < 0) i += 2 * n;
            i %= 2 * n;
            return i < n ? i : 2 * n - 1 - i;
        case Wrap::black:
            return i < 0 || i >= n ? -1 : i;
    }
    return -1;
}

double box(double d) { return d >= -0.5 && d < 0.5 ? 1 : 0; }
double tent(double d) { return std::max(0.0, 1 - std::abs(d)); }
double bspline(double d) {
    d = std::abs(d);
    if (d < 1) return 2.0 / 3 - d * d + d * d * d / 2;
    return d < 2 ? (2 - d) * (2 - d) * (2 - d) / 6 : 0;
}

/// Sum over all texels of kernel(distance) * texel, x and y in texels.
double convolved(const std::vector<std::uint8_t>& texels, double x, double y, Wrap wrap,
                 double (*kernel)(double)) {
    double sum = 0;
    const int cx = static_cast<int>(std::floor(x)), cy = static_cast<int>(std::floor(y));
    for (int j = cy - 3; j <= cy + 3; ++j)
        for (int i = cx - 3; i <= cx + 3; ++i) {
            const int px = place_in(i, kW, wrap), py = place_in(j, kH, wrap);
            if (px < 0 || py < 0) continue;
            sum += kernel(i + 0.5 - x) * kernel(j + 0.5 - y) *
                   texels[static_cast<std::size_t>(py * kW + px)] / 255.0;
        }
    return sum;
}

}  // namespace

TEST_CASE("texture filters: closest, bilinear and bicubic are their kernels, for every wrap mode") {
    const TempFolder folder;
    const auto texels = noise_bytes(kW * kH);
    write_tiff(folder / "a.tif", kW, kH, 1, 0, texels);
    const std::pair<TextureFilter, double (*)(double)> filters[] = {
        {TextureFilter::closest, box},
        {TextureFilter::bilinear, tent},
        {TextureFilter::bicubic, bspline}};
    for (const auto& each : filters)
        for (const Wrap wrap : kWraps) {
            const TextureFilter filter = each.first;
            const auto kernel = each.second;
            CAPTURE(int(filter));
            CAPTURE(int(wrap));
            TestStore s;
            s.load({texture_of(folder / "a.tif", filter, wrap)});
            double worst = 0;
            for (float u = -2.03f; u < 3; u += 0.0713f)
                for (float v = -2.01f; v < 3; v += 0.0937f) {
                    const double wanted =
                        convolved(texels, double(u) * kW, (1 - double(v)) * kH, wrap, kernel);
                    worst = std::max(worst, std::abs(double(s->sample(0, u, v, 0)[0]) - wanted));
                }
            // u is rounded to 2^-22 when it is folded: a slope of 7 texels a unit makes 2e-6.
            CHECK(worst < 1e-5);
        }
}

TEST_CASE("texture filters: bicubic keeps constants and straight lines at every level") {
    const TempFolder folder;
    std::vector<std::uint16_t> flat(64 * 64, 40000), ramp;
    for (int i = 0; i < 64 * 64; ++i) ramp.push_back(static_cast<std::uint16_t>(i % 64 * 1000));
    write_tiff(folder / "flat.tif", 64, 64, 1, 0, flat);
    write_tiff(folder / "ramp.tif", 64, 64, 1, 0, ramp);
    TestStore s;
    s.load({texture_of(folder / "flat.tif", TextureFilter::bicubic),
            texture_of(folder / "ramp.tif", TextureFilter::bicubic)});
    for (const float width : {0.0f, 1.0f / 64, 2.7f / 64, 4.0f / 64, 1.0f})
        for (float u = 0.01f; u < 1; u += 0.0317f) {
            CHECK(s->sample(0, u, 0.3f, width)[0] ==
                  doctest::Approx(40000 / 65535.0).epsilon(1e-6));
            // Three texels of a level from the seam nothing of it is felt.
            if (width > 5.0f / 64 || u < 0.2f || u > 0.8f) continue;
            const double wanted = (double(u) * 64 - 0.5) * 1000 / 65535;
            // 16-bit codes in the coarser levels.
            CHECK(std::abs(double(s->sample(1, u, 0.3f, width)[0]) - wanted) < 2e-5);
        }
}

TEST_CASE("texture filters: closest and bilinear read the finest level whatever the footprint") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", kW, kH, 1, 0, noise_bytes(kW * kH));
    TestStore s;
    s.load({texture_of(folder / "a.tif", TextureFilter::closest),
            texture_of(folder / "a.tif", TextureFilter::bilinear),
            texture_of(folder / "a.tif", TextureFilter::bicubic)});
    for (int t = 0; t < 2; ++t)
        CHECK(s->sample(t, 0.4f, 0.3f, 0) == s->sample(t, 0.4f, 0.3f, 0.6f));
    CHECK(s->sample(2, 0.4f, 0.3f, 0) != s->sample(2, 0.4f, 0.3f, 0.6f));
}

TEST_CASE("texture filters: the mean of stochastic draws is the trilinear value") {
    const TempFolder folder;
    write_tiff(folder / "a.tif", 16, 16, 1, 0, noise_bytes(256));
    write_tiff(folder / "rgba.tif", kW, kH, 4, 2, noise_bytes(kW * kH * 4));
    constexpr int kDraws = 20000;
    int cases = 0;
    for (const char* file : {"a.tif", "rgba.tif"})
        for (const Wrap wrap : kWraps) {
            TestStore s;
            s.load({texture_of(folder / file, TextureFilter::stochastic, wrap),
                    texture_of(folder / file, TextureFilter::trilinear, wrap)});
            for (const auto& [u, v, width] : {std::array{0.413f, 0.271f, 0.0f},
                                              {0.98f, 0.03f, 0.2f},
                                              {1.01f, 0.5f, 0.0f},
                                              {0.3f, 0.6f, 0.37f}}) {
                const Texel wanted = s->sample(1, u, v, width);
                for (const std::size_t c : {std::size_t(0), std::size_t(3)}) {
                    double sum = 0, squares = 0;
                    for (std::uint32_t seed = 0; seed < kDraws; ++seed) {
                        const double x = double(s->sample(0, u, v, width, seed)[c]);
                        sum += x;
                        squares += x * x;
                    }
                    const double mean = sum / kDraws;
                    const double variance = std::max(0.0, squares / kDraws - mean * mean) / kDraws;
                    // 64 z-tests: the chance that one of them is beyond 4.5 sigma is 4e-4.
                    CHECK(std::abs(mean - double(wanted[c])) <= 4.5 * std::sqrt(variance) + 1e-6);
                    ++cases;
                }
            }
        }
    CHECK(cases == 64);
}

TEST_CASE("texture filters: a stochastic draw is a texel, decided by seed and place alone") {
    const TempFolder folder;
    const auto texels = noise_bytes(256);
    write_tiff(folder / "a.tif", 16, 16, 1, 0, texels);
    const std::set<std::uint8_t> known(texels.begin(), texels.end());
    TestStore s, again;
    s.load({texture_of(folder / "a.tif", TextureFilter::stochastic)});
    again.load({texture_of(folder / "a.tif", TextureFilter::stochastic)});
    std::set<float> seen;
    for (std::uint32_t seed = 0; seed < 200; ++seed) {
        const float x = s->sample(0, 0.4f, 0.55f, 0, seed)[0];
        CHECK(known.contains(static_cast<std::uint8_t>(x * 255 + 0.5f)));
        CHECK(x == again->sample(0, 0.4f, 0.55f, 0, seed)[0]);
        seen.insert(x);
    }
    CHECK(seen.size() == 4);  // all four of the bilinear cell
}

TEST_CASE("texture filters: any place, footprint and filter gives finite values") {
    const TempFolder folder;
    constexpr float kInf = std::numeric_limits<float>::infinity();
    write_tiff(folder / "a.tif", 3, 2, 3, 0, noise_bytes(18));
    write_tiff(folder / "one.tif", 1, 1, 1, 0, noise_bytes(1));
    std::vector<TextureDesc> descs;
    for (const char* file : {"a.tif", "one.tif"})
        for (const TextureFilter filter : kTextureFilters)
            for (const Wrap wrap : kWraps) descs.push_back(texture_of(folder / file, filter, wrap));
    TestStore s;
    s.load(descs);
    for (int t = 0; t < s->size(); ++t)
        for (const float u : {0.0f, std::nanf(""), kInf, -kInf, 1e30f, -1e30f, 16777217.0f, 0.5f})
            for (const float width : {0.0f, std::nanf(""), kInf, 0.3f})
                for (const Texel& texel :
                     {s->sample(t, u, 0.3f, width, 7), s->sample(t, 0.3f, u, width, 8)})
                    for (const float v : texel) CHECK((std::isfinite(v) && v >= 0 && v <= 1));
}

TEST_CASE("texture: texels that are no number read as 0 and are counted") {
    const TempFolder folder;
    const float nan = std::nanf("");
    constexpr float kInf = std::numeric_limits<float>::infinity();
    write_tiff(folder / "nan.tif", 4, 1, 1, 0, std::vector<float>{nan, 2, -kInf, kInf});
    std::vector<TextureDesc> descs;
    for (const TextureFilter filter : kTextureFilters)
        descs.push_back(texture_of(folder / "nan.tif", filter, Wrap::clamp));
    TestStore s;
    s.load(descs);
    REQUIRE(s.problems.warnings().size() == 1);
    CHECK(s.problems.warnings()[0].find("3 values are not finite; read as 0") != std::string::npos);
    for (int t = 0; t < s->size(); ++t)
        for (float u = 0; u < 1; u += 0.01f) {
            const float x = s->sample(t, u, 0.5f, 0.1f, 3)[0];
            CHECK((x >= 0 && x <= 2));
        }
    CHECK(s->sample(1, 0.1f, 0.5f, 0)[0] == 0);
    CHECK(s->sample(1, 0.4f, 0.5f, 0)[0] == 2);
    // Out of the tile cache too, where nothing is looked at beforehand: the same texels as halves.
    Pyramid tiled;
    tiled.type = TexelType::half;
    tiled.channels = 1;
    tiled.levels = {{0, 4, 1}, {64, 2, 1}, {128, 1, 1}};
    tiled.words.assign(192, 0x4000);
    tiled.words[0] = 0x7e00;
    tiled.words[2] = 0xfc00;
    tiled.words[3] = 0x7c00;
    write_tx(tiled, folder / "nan.tx");
    for (TextureDesc& desc : descs) desc.file = folder / "nan.tx";
    TestStore cached;
    TextureOptions tight;
    tight.memory_bytes = 1;
    cached.load(descs, TextureUse::data, tight);
    REQUIRE(cached->counts().cached == 1);
    CHECK(cached->sample(1, 0.1f, 0.5f, 0)[0] == 0);
    CHECK(cached->sample(1, 0.4f, 0.5f, 0)[0] == 2);
    CHECK(cached->sample(2, 0.375f, 0.5f, 0)[0] == doctest::Approx(2));
}

TEST_CASE("texture: a picture of no pixels is refused, and magenta when lenient") {
    const TempFolder folder;
    write_tiff(folder / "none.tif", 0, 0, 1, 0, std::vector<std::uint8_t>{});
    TestStore s, lenient;
    s.load({texture_of(folder / "none.tif")});
    REQUIRE(s.problems.errors().size() == 1);
    CHECK(s.problems.errors()[0].find("none.tif") != std::string::npos);
    lenient.problems = Problems(Strictness::lenient);
    lenient.load({texture_of(folder / "none.tif", TextureFilter::bicubic)});
    CHECK(lenient.problems.errors().empty());
    CHECK(lenient->sample(0, 0.3f, 0.3f, 0)[2] == doctest::Approx(1));
}
