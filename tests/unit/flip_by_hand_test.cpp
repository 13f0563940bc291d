// FLIP once more, slowly: in double, by two-dimensional kernels as the paper writes them.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "renderer/compare/flip.h"
#include "renderer/core/cie.h"
#include "tests/support/test_picture.h"

using namespace tessera;

namespace {

constexpr double kPi = std::numbers::pi;
using Plane = std::function<double(int, int)>;  // of x, y
using Weight = std::function<double(double, double)>;

// Rows of Rec. 709 to XYZ over white, from the inverse.
Vec3d xyz_of(Vec3d c) {
    const Vec3d a = kXyzToRed, b = kXyzToGreen, d = kXyzToBlue;
    const double det = dot(a, cross(b, d));
    const auto back = [&](Vec3d rgb) {
        return (rgb.x * cross(b, d) + rgb.y * cross(d, a) + rgb.z * cross(a, b)) / det;
    };
    const Vec3d v = back(c), white = back({1, 1, 1});
    return {v.x / white.x, v.y / white.y, v.z / white.z};
}

Vec3d hunt_lab(Vec3d rgb) {
    const auto f = [](double t) {
        const double d = 6.0 / 29;
        return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    };
    const Vec3d t = xyz_of(rgb);
    const double l = 116 * f(t.y) - 16;
    return {l, 0.01 * l * 500 * (f(t.x) - f(t.y)), 0.01 * l * 200 * (f(t.y) - f(t.z))};
}

double distance(Vec3d a, Vec3d b) {
    return std::fabs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// Sum over the square of the weights divided by their sum, or positive and negative ones by theirs.
double filtered(const Plane& plane, const Weight& weight, int radius, int x, int y) {
    double above = 0, below = 0, sum_above = 0, sum_below = 0;
    for (int j = -radius; j <= radius; ++j) {
        for (int i = -radius; i <= radius; ++i) {
            const double w = weight(i, j), v = plane(x + i, y + j);
            (w > 0 ? above : below) += std::fabs(w);
            (w > 0 ? sum_above : sum_below) += w * v;
        }
    }
    return sum_above / above + (below > 0 ? sum_below / below : 0);
}

class SlowFlip {
public:
    SlowFlip(const TestPicture& picture, double ppd) : picture_(picture), ppd_(ppd) {}

    Vec3d lab(int x, int y) const {
        const int radius =
            static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd_));
        std::array<double, 3> o{};
        for (std::size_t c = 0; c < 3; ++c)
            o[c] = filtered([&](int i, int j) { return opponent(c, i, j); },
                            [&](double i, double j) { return sensitivity(c, i, j); }, radius, x, y);
        const double t = (o[0] + 16) / 116, tx = o[1] / 500 + t, tz = t - o[2] / 200;
        const Vec3d xyz{tx * 0.95047, t, tz * 1.08883};
        const Vec3d rgb = xyz_to_rec709(xyz);
        return hunt_lab({std::clamp(rgb.x, 0.0, 1.0), std::clamp(rgb.y, 0.0, 1.0),
                         std::clamp(rgb.z, 0.0, 1.0)});
    }

    // Length of the gradient, of first or second derivatives.
    double feature(bool second, int x, int y) const {
        const double s = 0.5 * 0.082 * ppd_;
        const int radius = static_cast<int>(std::ceil(3 * s));
        const auto weight = [&](double along, double i, double j) {
            const double g = std::exp(-(i * i + j * j) / (2 * s * s));
            return (second ? along * along / (s * s) - 1 : -along) * g;
        };
        const auto light = [&](int i, int j) { return (opponent(0, i, j) + 16) / 116; };
        return std::hypot(
            filtered(
                light, [&](double i, double j) { return weight(i, i, j); }, radius, x, y),
            filtered(
                light, [&](double i, double j) { return weight(j, i, j); }, radius, x, y));
    }

private:
    double opponent(std::size_t c, int x, int y) const {
        const int i = std::clamp(x, 0, picture_.width - 1);
        const int j = std::clamp(y, 0, picture_.height - 1);
        const auto p = picture_.view().pixel(static_cast<std::size_t>(j * picture_.width + i));
        const Vec3d t = xyz_of({double{p[0]}, double{p[1]}, double{p[2]}});
        return std::array{116 * t.y - 16, 500 * (t.x - t.y), 200 * (t.y - t.z)}[c];
    }

    // Table 1 of the paper.
    double sensitivity(std::size_t c, double i, double j) const {
        const double d2 = (i * i + j * j) / (ppd_ * ppd_);
        const auto bell = [&](double a, double b) {
            return a * std::sqrt(kPi / b) * std::exp(-kPi * kPi * d2 / b);
        };
        return c == 0   ? bell(1, 0.0047)
               : c == 1 ? bell(1, 0.0053)
                        : bell(34.1, 0.04) + bell(13.5, 0.025);
    }

    const TestPicture& picture_;
    double ppd_;
};

double slow_flip(const TestPicture& a, const TestPicture& r, double ppd, int x, int y) {
    const SlowFlip sa(a, ppd), sr(r, ppd);
    const double most = std::pow(distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
    const double d = std::pow(distance(sa.lab(x, y), sr.lab(x, y)), 0.7), knee = 0.4 * most;
    const double colour =
        d < knee ? d * 0.95 / knee : 0.95 + (d - knee) / (most - knee) * (1 - 0.95);
    const double feature = std::max(std::fabs(sa.feature(false, x, y) - sr.feature(false, x, y)),
                                    std::fabs(sa.feature(true, x, y) - sr.feature(true, x, y)));
    return std::pow(colour, 1 - std::sqrt(feature / std::sqrt(2.0)));
}

}  // namespace

TEST_CASE("flip: bands of separable filters give what the paper's kernels give") {
    Workers workers(2);
    // Colours and smooth shapes, so that every filter has something to do.
    TestPicture a = noise(40, 30, 3, 1), r = noise(40, 30, 3, 2);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            r.at(x, y, 0) = 0.5f + 0.4f * std::sin(0.2f * static_cast<float>(x));
            a.at(x, y, 2) = 0.5f + 0.4f * std::sin(0.3f * static_cast<float>(x + y));
        }
    for (const double ppd : {30.0, 67.0}) {
        const std::vector<float> map = ldr_flip(a.view(), r.view(), ppd, workers);
        for (int y = 0; y < 30; y += 7)
            for (int x = 0; x < 40; x += 9)
                // floats, and narrow kernels cut at six sigma
                CHECK(map[static_cast<std::size_t>(y * 40 + x)] ==
                      doctest::Approx(slow_flip(a, r, ppd, x, y)).epsilon(1e-3));
    }
}
