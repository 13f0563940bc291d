#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "renderer/compare/compare_layer.h"
#include "renderer/compare/squared_error.h"
#include "renderer/compare/ssim.h"
#include "tests/support/test_picture.h"

using namespace tessera;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

LayerScores compared(const TestPicture& a, const TestPicture& b, CompareOptions options = {},
                     LayerContent content = LayerContent::colour) {
    Workers workers(2);
    std::vector<std::string> names{"R", "G", "B", "A"};
    if (a.channels < 3) names = {"Y", "A"};
    names.resize(static_cast<std::size_t>(a.channels));
    return compare_layer({names, content, a.view(), b.view()}, options, workers);
}

double value(const LayerScores& scores, Metric metric) {
    const auto& v = scores.values[static_cast<std::size_t>(metric)];
    REQUIRE(v.has_value());
    return *v;
}

bool measured(const LayerScores& scores, Metric metric) {
    return scores.values[static_cast<std::size_t>(metric)].has_value();
}

}  // namespace

TEST_CASE("compare: a constant offset has the errors that it must") {
    const TestPicture r(20, 10, 3, 2.0f), a(20, 10, 3, 2.5f);
    const SquaredErrors e = squared_errors(a.view(), r.view(), 0.25);
    CHECK(e.rmse == doctest::Approx(0.5));
    CHECK(e.relmse == doctest::Approx(0.25 / 4.25));
    CHECK(e.trimmed_relmse == doctest::Approx(0.25 / 4.25));
    CHECK(psnr(e.rmse, 2) == doctest::Approx(20 * std::log10(4.0)));
}

TEST_CASE("compare: RMSE is over pixels and channels") {
    TestPicture r(2, 1, 3, 0.0f), a = r;
    a.at(0, 0, 1) = 3;
    CHECK(squared_errors(a.view(), r.view(), 1).rmse == doctest::Approx(std::sqrt(9.0 / 6)));
}

TEST_CASE("compare: trimming leaves out the worst thousandth and nothing else") {
    TestPicture r(100, 30, 1, 1.0f), a(100, 30, 1, 1.1f);
    for (int i = 0; i < 3; ++i) a.at(7 * i, i, 0) = 1000;
    const SquaredErrors e = squared_errors(a.view(), r.view(), 0);
    CHECK(e.trimmed_relmse == doctest::Approx(0.01).epsilon(1e-5));  // 1.1 is rounded to float
    CHECK(e.relmse == doctest::Approx((3 * 998001.0 + 2997 * 0.01) / 3000).epsilon(1e-5));
    a.at(50, 20, 0) = 1000;  // a fourth one is more than a thousandth
    CHECK(squared_errors(a.view(), r.view(), 0).trimmed_relmse ==
          doctest::Approx((998001.0 + 2996 * 0.01) / 2997).epsilon(1e-5));
}

TEST_CASE("compare: relMSE does not depend on exposure") {
    const TestPicture r = noise(32, 16, 3, 1), a = noise(32, 16, 3, 2);
    const LayerScores one = compared(a, r), bright = compared(scaled(a, 64), scaled(r, 64));
    CHECK(value(one, Metric::relmse) == value(bright, Metric::relmse));  // 64 is a power of 2
    CHECK(value(bright, Metric::rmse) == 64 * value(one, Metric::rmse));
    CHECK(value(one, Metric::psnr) == doctest::Approx(value(bright, Metric::psnr)));
}

TEST_CASE("compare: the default epsilon is a hundredth of the squared mean, and can be given") {
    const TestPicture r(16, 16, 3, 3.0f), a(16, 16, 3, 3.3f);
    const LayerScores scores = compared(a, r);
    CHECK(*scores.epsilon == doctest::Approx(0.09));
    CHECK(value(scores, Metric::relmse) == doctest::Approx(0.09 / 9.09).epsilon(1e-5));
    CompareOptions options;
    options.epsilon = 1.0;
    CHECK(value(compared(a, r, options), Metric::relmse) == doctest::Approx(0.009).epsilon(1e-5));
}

TEST_CASE("compare: over black, relative errors are none or infinite, never NaN") {
    const TestPicture black(12, 12, 3, 0.0f), grey(12, 12, 3, 0.5f);
    const LayerScores same = compared(black, black), other = compared(grey, black);
    CHECK(value(same, Metric::relmse) == 0);
    CHECK(std::isinf(value(other, Metric::relmse)));
    CHECK(std::isinf(value(other, Metric::bias)));
    CHECK(value(same, Metric::bias) == 0);
    CHECK_FALSE(measured(other, Metric::psnr));
    CHECK(value(other, Metric::flip) > 0.3);
    CHECK(value(same, Metric::ssim) == 1);
}

TEST_CASE("compare: equal pictures differ in nothing") {
    const TestPicture p = noise(40, 30, 3, 5);
    for (const bool encoded : {false, true}) {
        CompareOptions options;
        options.encoded = encoded;
        const LayerScores scores = compared(p, p, options);
        for (const Metric m : {Metric::rmse, Metric::relmse, Metric::trimmed_relmse, Metric::flip,
                               Metric::max_abs, Metric::bias, Metric::different})
            CHECK_MESSAGE(value(scores, m) == 0, name_of(m));
        CHECK(value(scores, Metric::ssim) == 1);
        CHECK(std::isinf(value(scores, Metric::psnr)));
    }
}

TEST_CASE("compare: the ratio of means is told channel by channel, and the worst is the bias") {
    TestPicture r = noise(16, 16, 3, 8), a = r;
    for (std::size_t i = 1; i < a.values.size(); i += 3) a.values[i] *= 0.5f;
    for (std::size_t i = 2; i < a.values.size(); i += 3) a.values[i] *= 1.25f;
    const LayerScores scores = compared(a, r);
    CHECK(*scores.channels[0].mean_ratio == 1);
    CHECK(*scores.channels[1].mean_ratio == 0.5);
    CHECK(*scores.channels[2].mean_ratio == doctest::Approx(1.25));
    CHECK(value(scores, Metric::bias) == doctest::Approx(0.5));
}

TEST_CASE("compare: what is not finite is counted, left out, and nothing else with it") {
    TestPicture r(24, 24, 3, 1.0f), a(24, 24, 3, 1.5f);
    a.at(3, 4, 0) = kNan, a.at(3, 4, 1) = -2, a.at(5, 6, 2) = -kInf;
    r.at(7, 8, 1) = kInf;
    CompareOptions options;
    options.maps = true;
    const LayerScores scores = compared(a, r, options);
    CHECK(value(scores, Metric::non_finite) == 3);
    CHECK(value(scores, Metric::rmse) == doctest::Approx(0.5));
    CHECK(value(scores, Metric::max_abs) == 0.5);
    CHECK(scores.channels[0].a == ValueCounts{1, 0, 0});
    CHECK(scores.channels[1].a == ValueCounts{0, 0, 1});
    CHECK(scores.channels[2].a == ValueCounts{0, 1, 1});
    CHECK(scores.channels[1].reference == ValueCounts{0, 1, 0});
    for (const Metric m : {Metric::flip, Metric::ssim, Metric::psnr, Metric::relmse})
        CHECK_MESSAGE(std::isfinite(value(scores, m)), name_of(m));
    CHECK(std::isnan(scores.relative[4 * 24 + 3]));
    CHECK(std::isnan(scores.flip[6 * 24 + 5]));
    double sum = 0;
    for (const float v : scores.flip) sum += std::isnan(v) ? 0 : static_cast<double>(v);
    CHECK(value(scores, Metric::flip) == doctest::Approx(sum / 573));
    CHECK(value(scores, Metric::different) == 1);
}

TEST_CASE("compare: pixels that are left out do not move the map of the others") {
    TestPicture r(24, 24, 3, 1.0f), a = r;
    a.at(3, 4, 0) = kNan, a.at(5, 6, 2) = kNan;
    for (int c = 0; c < 3; ++c) a.at(20, 20, c) = 1.5f;
    CompareOptions options;
    options.maps = true;
    const LayerScores scores = compared(a, r, options);
    for (std::size_t i = 0; i < scores.relative.size(); ++i) {
        if (i == 4 * 24 + 3 || i == 6 * 24 + 5) continue;
        CHECK(scores.relative[i] ==
              doctest::Approx(i == 20 * 24 + 20 ? 0.5 / std::sqrt(1.01) : 0.0));
    }
}

TEST_CASE("compare: zero is not negative, in a channel's counts") {
    TestPicture p(2, 2, 1, 0.0f);
    p.at(0, 0, 0) = -0.0f, p.at(1, 0, 0) = -1;
    CHECK(count_values(p.view())[0] == ValueCounts{0, 0, 1});
}

TEST_CASE("compare: with no finite pixel only counts are told") {
    const TestPicture r(12, 12, 3, 1.0f), a(12, 12, 3, kNan);
    const LayerScores scores = compared(a, r);
    CHECK(value(scores, Metric::non_finite) == 144);
    CHECK_FALSE(measured(scores, Metric::rmse));
    CHECK_FALSE(measured(scores, Metric::flip));
}

TEST_CASE("compare: sameness is of bits, but for zeros and NaN") {
    TestPicture r(4, 1, 1, 1.0f), a(4, 1, 1, 1.0f);
    r.at(0, 0, 0) = 0.0f, a.at(0, 0, 0) = -0.0f;
    r.at(1, 0, 0) = kNan, a.at(1, 0, 0) = -kNan;
    a.at(2, 0, 0) = std::nextafter(1.0f, 2.0f);
    // a denormal is an id like another, though arithmetic flushes it to zero
    r.at(3, 0, 0) = 0.0f, a.at(3, 0, 0) = std::numeric_limits<float>::denorm_min();
    CHECK(differing(a.view(), r.view()) == std::vector<std::uint8_t>{0, 0, 1, 1});
}

TEST_CASE("compare: ids are the same or not, data has errors without colours'") {
    const TestPicture r = noise(16, 16, 3, 1);
    TestPicture a = r;
    a.at(2, 2, 0) += 4;
    const LayerScores ids = compared(a, r, {}, LayerContent::ids);
    CHECK(value(ids, Metric::different) == 1.0 / 256);
    CHECK_FALSE(measured(ids, Metric::rmse));
    const LayerScores data = compared(a, r, {}, LayerContent::data);
    CHECK(value(data, Metric::max_abs) == doctest::Approx(4));
    CHECK(value(data, Metric::rmse) == doctest::Approx(4 / std::sqrt(768.0)));
    CHECK_FALSE(measured(data, Metric::relmse));
    CHECK_FALSE(measured(data, Metric::flip));
}

TEST_CASE("compare: alpha is no colour") {
    const TestPicture r = noise(16, 16, 4, 1);
    TestPicture a = r;
    for (std::size_t i = 3; i < a.values.size(); i += 4) a.values[i] += 1;
    const LayerScores scores = compared(a, r);
    CHECK(value(scores, Metric::rmse) == 0);
    CHECK(value(scores, Metric::flip) == 0);
    CHECK(value(scores, Metric::max_abs) == doctest::Approx(1));
    CHECK(value(scores, Metric::different) == 1);
    const TestPicture grey = noise(16, 16, 2, 1);
    TestPicture thin = grey;
    for (std::size_t i = 1; i < thin.values.size(); i += 2) thin.values[i] += 1;
    CHECK(value(compared(thin, grey), Metric::rmse) == 0);
}

TEST_CASE("ssim: of flat pictures it is the luminance term alone") {
    Workers workers(2);
    const TestPicture a(16, 16, 1, 0.3f), b(16, 16, 1, 0.6f);
    const double c1 = 1e-4;  // Wang et al. 2004: variances are 0, their ratio 1
    CHECK(*ssim(a.view(), b.view(), workers) ==
          doctest::Approx((2 * 0.18 + c1) / (0.09 + 0.36 + c1)).epsilon(1e-4));
}

TEST_CASE("ssim: of a checkerboard and its negative it is as the closed form") {
    Workers workers(2);
    TestPicture a(64, 64, 1, 0.0f), b = a;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) a.at(x, y, 0) = (x + y) % 2 ? 0.7f : 0.3f;
    for (std::size_t i = 0; i < b.values.size(); ++i) b.values[i] = 1 - a.values[i];
    // The window's mean is 0.5 but for a 1e-9 (the checkerboard's frequency is far above the
    // Gaussian's), its variance 0.04, the covariance -0.04.
    const double c2 = 9e-4;
    CHECK(*ssim(a.view(), b.view(), workers) ==
          doctest::Approx((-0.08 + c2) / (0.08 + c2)).epsilon(1e-3));
}

TEST_CASE("ssim: it is symmetric, does not depend on threads, and needs a window's size") {
    const auto by = [](int threads, const TestPicture& p, const TestPicture& q) {
        Workers workers(threads);
        return ssim(p.view(), q.view(), workers);
    };
    const TestPicture a = noise(40, 90, 1, 1), b = noise(40, 90, 1, 2);
    CHECK(*by(1, a, b) == *by(2, b, a));
    CHECK(*by(1, a, b) < 0.5);
    const TestPicture small = noise(10, 90, 1, 1);
    CHECK_FALSE(by(1, small, small).has_value());
}

TEST_CASE("ssim: light is shown with its mean at 0.18, whatever the exposure") {
    const TestPicture p = noise(16, 16, 3, 3);
    const std::vector<float> once =
        shown_luminance(p.values, ShownAs::compressed, exposure_of(p.values));
    const TestPicture bright = scaled(p, 1024);
    CHECK(once == shown_luminance(bright.values, ShownAs::compressed, exposure_of(bright.values)));
    const std::vector<float> grey(3, 7.0f);
    // 0.18 / 1.18 in sRGB's curve
    CHECK(shown_luminance(grey, ShownAs::compressed, exposure_of(grey))[0] ==
          doctest::Approx(1.055 * std::pow(0.18 / 1.18, 1 / 2.4) - 0.055));
}
