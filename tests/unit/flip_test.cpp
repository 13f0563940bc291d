#include "renderer/compare/flip.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "renderer/compare/eye_colour.h"
#include "renderer/compare/row_filter.h"
#include "renderer/compare/tone_curve.h"
#include "tests/support/test_picture.h"

using namespace tessera;

namespace {

TestPicture flat(int width, int height, float r, float g, float b) {
    TestPicture p(width, height, 3, 0);
    for (std::size_t i = 0; i < p.values.size(); i += 3)
        p.values[i] = r, p.values[i + 1] = g, p.values[i + 2] = b;
    return p;
}

std::vector<float> ldr(const TestPicture& a, const TestPicture& b, double ppd = kPixelsPerDegree) {
    Workers workers(2);
    return ldr_flip(a.view(), b.view(), ppd, workers);
}

std::vector<float> hdr(const TestPicture& a, const TestPicture& b) {
    Workers workers(2);
    return hdr_flip(a.view(), b.view(), kPixelsPerDegree, workers);
}

double mean(const std::vector<float>& values) {
    double sum = 0;
    for (const float v : values) sum += static_cast<double>(v);
    return sum / static_cast<double>(values.size());
}

}  // namespace

TEST_CASE("flip: the powers of pixels are those of the library") {
    for (float x = 1e-30f; x < 1e30f; x *= 1.7f) {
        CHECK(log2_of(x) == doctest::Approx(std::log2(x)).epsilon(1e-6));
        if (x > 1e-8f && x < 1e8f)
            CHECK(power_of(x, 0.7f) == doctest::Approx(std::pow(x, 0.7f)).epsilon(2e-6));
        CHECK(power_of(x, 1 / 3.0f) == doctest::Approx(std::cbrt(x)).epsilon(4e-6));
    }
    CHECK(power_of(0, 0.7f) == 0);
    CHECK(power_of(1, 0.3f) == 1);
}

TEST_CASE("flip: the opponent space leads back, and white is L* 100 without hue") {
    for (const Colour3 c : {Colour3{0, 0, 0}, Colour3{1, 1, 1}, Colour3{0.2f, 0.7f, 0.1f}}) {
        const Colour3 o = to_opponent(c[0], c[1], c[2]);
        const Colour3 back = from_opponent(o[0], o[1], o[2]);
        for (std::size_t i = 0; i < 3; ++i) CHECK(back[i] == doctest::Approx(c[i]).epsilon(1e-5));
    }
    const Colour3 white = to_hunt_lab(1, 1, 1), black = to_hunt_lab(0, 0, 0);
    CHECK(white[0] == doctest::Approx(100).epsilon(1e-5));
    CHECK(std::fabs(white[1]) < 1e-3);
    CHECK(std::fabs(white[2]) < 1e-3);
    CHECK(hyab(white, black) == doctest::Approx(100).epsilon(1e-4));
}

TEST_CASE("flip: green against blue is the greatest difference there is, 1") {
    const auto map = ldr(flat(30, 20, 0, 1, 0), flat(30, 20, 0, 0, 1));
    for (const float v : map) CHECK(v == doctest::Approx(1).epsilon(1e-5));
}

TEST_CASE("flip: black against white is as the paper's formulas give by hand") {
    // CIELAB (L*, a*, b*) of green (87.735, -86.183, 83.179) and blue (32.297, 79.188, -107.860),
    // with Hunt's factor (.., -75.612, 72.977) and (.., 25.575, -34.836): HyAB 203.30, ^0.7
    // = 41.28. Black and white differ by 100^0.7 = 25.119, above the knee 0.4 * 41.28 = 16.51: 0.95
    // + 0.05 (25.119 - 16.51) / (41.28 - 16.51) = 0.9674. No features in flat pictures.
    const auto map = ldr(flat(30, 20, 0, 0, 0), flat(30, 20, 1, 1, 1));
    for (const float v : map) CHECK(v == doctest::Approx(0.9674).epsilon(1e-4));
    // A difference below the knee: grey of L* 50 against black, 50^0.7 = 15.462, / 16.51 * 0.95.
    const float y = std::pow(66.0f / 116, 3.0f);
    const auto grey = ldr(flat(30, 20, y, y, y), flat(30, 20, 0, 0, 0));
    CHECK(grey[77] == doctest::Approx(0.8897).epsilon(1e-3));
}

TEST_CASE("flip: equal pictures do not differ, and the order of two does not matter") {
    const TestPicture a = noise(70, 150, 3, 1), b = noise(70, 150, 3, 2);
    CHECK(mean(ldr(a, a)) == 0);
    CHECK(mean(hdr(a, a)) == 0);
    CHECK(ldr(a, b) == ldr(b, a));
    CHECK(mean(ldr(a, b)) > 0.1);
}

TEST_CASE("flip: a greater difference is seen more") {
    const TestPicture grey = flat(24, 24, 0.3f, 0.3f, 0.3f);
    double before = 0;
    for (const float d : {0.01f, 0.02f, 0.05f, 0.1f, 0.3f, 0.7f}) {
        const double now = mean(ldr(flat(24, 24, 0.3f + d, 0.3f, 0.3f), grey));
        CHECK(now > before + 1e-3);
        before = now;
    }
}

TEST_CASE("flip: a dot is seen where it is, within the eye's reach, and nowhere else") {
    constexpr int kReach = 10;        // 3 sigma of the widest filter at 67 pixels per degree
    for (const int row : {61, 66}) {  // on either side of the border of two bands
        TestPicture r = flat(101, 141, 0.2f, 0.2f, 0.2f), a = r;
        for (int c = 0; c < 3; ++c) a.at(50, row, c) = 1;
        const auto map = ldr(a, r);
        const auto at = [&](int x, int y) { return map[static_cast<std::size_t>(y * 101 + x)]; };
        for (int y = 0; y < 141; ++y)
            for (int x = 0; x < 101; ++x)
                if (std::abs(x - 50) > kReach || std::abs(y - row) > kReach) CHECK(at(x, y) == 0);
        for (int d = 1; d <= kReach; ++d) {
            CHECK(at(50 + d, row) == doctest::Approx(at(50 - d, row)).epsilon(1e-3));
            CHECK(at(50, row + d) == doctest::Approx(at(50, row - d)).epsilon(1e-3));
        }
        CHECK(at(50, row) > 0.2f);
        CHECK(at(50, row - 6) > 0);  // a grey dot is seen by the narrower filters alone
    }
}

TEST_CASE("flip: from farther away fine noise is seen less") {
    const TestPicture a = noise(96, 96, 3, 1), grey = flat(96, 96, 0.5f, 0.5f, 0.5f);
    const double near = mean(ldr(a, grey, 20)), far = mean(ldr(a, grey, 200));
    CHECK(far < 0.7 * near);
}

TEST_CASE("flip: a line is an edge; its contrast counts more than that of a flat field") {
    TestPicture a = flat(60, 60, 0.2f, 0.2f, 0.2f), r = a;
    for (int y = 0; y < 60; ++y)
        for (int x = 28; x < 32; ++x)
            for (int c = 0; c < 3; ++c) a.at(x, y, c) = 0.5f;
    const auto line = ldr(a, r);
    const auto field = ldr(flat(60, 60, 0.5f, 0.5f, 0.5f), r);
    CHECK(*std::max_element(line.begin(), line.end()) > field[0]);
}

TEST_CASE("flip: the picture does not depend on threads or on where bands begin") {
    const TestPicture a = noise(50, 300, 3, 4), b = noise(50, 300, 3, 9);
    const auto by_one = [&] {
        Workers one(1);
        return ldr_flip(a.view(), b.view(), 67, one);
    };
    CHECK(by_one() == ldr(a, b));
    // rows far from the edge are those of the picture without its first 37 rows
    TestPicture ta = a, tb = b;
    for (TestPicture* p : {&ta, &tb}) {
        p->values.erase(p->values.begin(), p->values.begin() + 37 * 50 * 3);
        p->height -= 37;
    }
    const auto whole = ldr(a, b), part = ldr(ta, tb);
    for (std::size_t i = 40 * 50; i < 200 * 50; ++i) CHECK(part[i] == whole[i + 37 * 50]);
}

TEST_CASE("hdr flip: exposures reach from the brightest to the median, told by the reference") {
    TestPicture r = flat(40, 40, 0.25f, 0.25f, 0.25f);
    for (int c = 0; c < 3; ++c) r.at(5, 5, c) = 64;  // eight stops above
    const std::vector<double> e = flip_exposures(r.view());
    REQUIRE(e.size() == 8);
    CHECK(tone_curve(64 * static_cast<float>(std::exp2(e.front()))) == doctest::Approx(0.85));
    CHECK(tone_curve(0.25f * static_cast<float>(std::exp2(e.back()))) == doctest::Approx(0.85));
    CHECK(e[1] - e[0] == doctest::Approx(8 / 7.0));
    CHECK(flip_exposures(flat(8, 8, 0, 0, 0).view()) == std::vector<double>{0.0});
    // most of it black: the median is that of what has light
    TestPicture spot = flat(40, 40, 0, 0, 0);
    for (int c = 0; c < 3; ++c) spot.at(5, 5, c) = 1;
    CHECK(flip_exposures(spot.view()).size() == 1);
}

TEST_CASE("hdr flip: exposure does not matter, and shadows count though highlights are there") {
    TestPicture r = flat(64, 64, 0.02f, 0.02f, 0.02f);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            for (int c = 0; c < 3; ++c) r.at(x, y, c) = 50;
    TestPicture a = r;
    for (int c = 0; c < 3; ++c) a.at(50, 50, c) = 0.05f;
    const auto map = hdr(a, r), bright = hdr(scaled(a, 256), scaled(r, 256));
    CHECK(map[50 * 64 + 50] > 0.1f);
    for (std::size_t i = 0; i < map.size(); ++i)
        CHECK(map[i] == doctest::Approx(bright[i]).epsilon(1e-3));
    // clamped as a display would, the highlights' difference would be lost
    TestPicture hot = r;
    for (int c = 0; c < 3; ++c) hot.at(4, 4, c) = 500;
    CHECK(hdr(hot, r)[4 * 64 + 4] > 0.05f);
    CHECK(mean(ldr(hot, r)) == 0);
}

TEST_CASE("hdr flip: light of any size gives numbers") {
    TestPicture r = flat(12, 12, 0, 0, 0), a = r;
    for (int c = 0; c < 3; ++c) r.at(5, 5, c) = 1e-44f, a.at(5, 5, c) = 3e38f;
    for (const float v : hdr(a, r)) CHECK(std::isfinite(v));
    for (const float v : hdr(r, a)) CHECK(std::isfinite(v));
    const TestPicture dot = flat(1, 1, 0.1f, 0.2f, 0.3f);
    CHECK(hdr(dot, dot) == std::vector<float>{0});
}

TEST_CASE("row filter: kernels have the sums of their paper") {
    double sum = 0, positive = 0, negative = 0;
    for (const float k : gaussian(2.7, 9)) sum += static_cast<double>(k);
    CHECK(sum == doctest::Approx(1));
    for (const Kernel& kernel : {gaussian_slope(2.7, 9), gaussian_bend(2.7, 9)}) {
        positive = negative = 0;
        for (const float k : kernel) (k > 0 ? positive : negative) += static_cast<double>(k);
        CHECK(positive == doctest::Approx(1));
        CHECK(negative == doctest::Approx(-1));
    }
}
