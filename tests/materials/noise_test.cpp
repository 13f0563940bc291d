#include "materials/nodes/noise.h"

#include <doctest/doctest.h>

#include <limits>

#include "tests/support/random.h"
#include "tests/support/statistics.h"

using namespace tessera;

namespace {

Vec2f point2(Random& r) { return {r.between(-500, 500), r.between(-500, 500)}; }
Vec3f point3(Random& r) {
    return {r.between(-500, 500), r.between(-500, 500), r.between(-500, 500)};
}

// A square of side w about a point of space, in a plane of any direction.
struct Plane {
    Vec3f x, y;
    explicit Plane(Random& r) {
        const Vec3d n = r.direction(), t = normalize(cross(n, r.direction()));
        x = Vec3f(t), y = Vec3f(cross(n, t));
    }
};

// Relative error of `filtered` against means of 8x8 points of the footprint, and that of the plain
// mean: both root mean square, over the deviation of the points.
struct FilterError {
    double filtered, plain_mean;
};
template <class F>
FilterError filter_error(float w, double mean, F f) {
    Random r(7);
    double filtered = 0, flat = 0;
    Mean points;
    for (int i = 0; i < 400; ++i) {
        const Vec3f p = point3(r);
        const Plane plane(r);
        double sum = 0;
        for (int k = 0; k < 64; ++k) {
            const float a = w * (static_cast<float>(k & 7) + r.unit() - 4.0f) / 8.0f;
            const float b = w * (static_cast<float>(k >> 3) + r.unit() - 4.0f) / 8.0f;
            const auto v = static_cast<double>(f(p, plane, a, b, 0.0f));
            sum += v, points.add(v);
        }
        filtered += std::pow(static_cast<double>(f(p, plane, 0.0f, 0.0f, w)) - sum / 64, 2);
        flat += std::pow(mean - sum / 64, 2);
    }
    const double scale = 1 / std::sqrt(points.variance());
    return {std::sqrt(filtered / 400) * scale, std::sqrt(flat / 400) * scale};
}

float in_plane_2d(float (*f)(Vec2f, float), Vec3f p, float a, float b, float w) {
    return f({p.x + a, p.y + b}, w);
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kHostile[] = {0.0f,  -0.0f,         1e-40f, -1e-40f, 0.5f,      -7.25f,    3e9f,
                              -3e9f, 2147483648.0f, 1e30f,  -1e30f,  kInfinity, -kInfinity};

}  // namespace

TEST_CASE("noise: mean, variance and range are those of MaterialX's noise") {
    Random r(1);
    Mean flat, solid;
    double largest = 0;
    for (int i = 0; i < 200000; ++i) {
        flat.add(static_cast<double>(noise2d(point2(r), 0)));
        solid.add(static_cast<double>(noise3d(point3(r), 0)));
        largest = std::max({largest, std::fabs(static_cast<double>(noise2d(point2(r), 0))),
                            std::fabs(static_cast<double>(noise3d(point3(r), 0)))});
    }
    CHECK(std::fabs(flat.mean()) < 4 * flat.error());
    CHECK(std::fabs(solid.mean()) < 4 * solid.error());
    // 4 sigma: a variance of n values of kurtosis 2.5 errs by sqrt(1.5 / n) of itself.
    CHECK(flat.variance() == doctest::Approx(0.1017).epsilon(0.011));
    CHECK(solid.variance() == doctest::Approx(0.0703).epsilon(0.011));
    CHECK(largest < 1.1);
    CHECK(largest > 0.9);
}

TEST_CASE("noise: zero at every lattice point") {
    for (int i = -40; i < 40; ++i) {
        const auto x = static_cast<float>(i), y = static_cast<float>(7 * i % 11);
        CHECK(noise2d({x, y}, 0) == 0.0f);
        CHECK(noise3d({x, y, -x}, 0) == 0.0f);
        CHECK(noise3d_vec3({y, x, x}, 0) == Vec3f(0.0f));
    }
}

TEST_CASE("noise: continuous across the walls of cells") {
    Random r(2);
    const float e = 1e-4f;
    for (int i = 0; i < 2000; ++i) {
        const float wall = std::floor(r.between(-30, 30)), y = r.between(-9, 9), z = r.unit();
        // No gradient is longer than about 4; the rest is rounding of the coordinate.
        const float limit = 4 * 2 * e + 1e-5f;
        CHECK(std::fabs(noise2d({wall - e, y}, 0) - noise2d({wall + e, y}, 0)) < limit);
        CHECK(std::fabs(noise2d({y, wall - e}, 0) - noise2d({y, wall + e}, 0)) < limit);
        CHECK(std::fabs(noise3d({y, z, wall - e}, 0) - noise3d({y, z, wall + e}, 0)) < limit);
    }
}

TEST_CASE("noise: three channels are not correlated, the first is the plain noise") {
    Random r(3);
    double xy = 0, yz = 0, xx = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const Vec3f p = point3(r), v = noise3d_vec3(p, 0);
        xy += static_cast<double>(v.x * v.y), yz += static_cast<double>(v.y * v.z);
        xx += static_cast<double>(v.x * v.x);
        if (i % 100 == 0) CHECK(v.x == noise3d(p, 0));
    }
    const double limit = 4 / std::sqrt(n);  // 4 sigma
    CHECK(std::fabs(xy / xx) < limit);
    CHECK(std::fabs(yz / xx) < limit);
}

TEST_CASE("fractal: one octave is the noise, more add their variances") {
    Random r(4);
    Mean sum;
    const FractalParams f{.octaves = 4, .diminish = 0.7f};
    for (int i = 0; i < 100000; ++i) {
        const Vec3f p = point3(r);
        if (i % 100 == 0) {
            CHECK(fractal3d(p, {.octaves = 1}, 0) == noise3d(p, 0));
            CHECK(fractal2d({p.x, p.y}, {.octaves = 1}, 0) == noise2d({p.x, p.y}, 0));
            CHECK(fractal3d_vec3(p, f, 0).x == fractal3d(p, f, 0));
            CHECK(fractal2d_vec3({p.x, p.y}, f, 0).x == fractal2d({p.x, p.y}, f, 0));
        }
        sum.add(static_cast<double>(fractal3d(p, f, 0)));
    }
    CHECK(std::fabs(sum.mean()) < 4 * sum.error());
    const auto expected = static_cast<double>(fractal3d_lost(f, kInfinity));
    CHECK(sum.variance() == doctest::Approx(expected).epsilon(0.02));  // 4 sigma
    CHECK(fractal3d_lost(f, 0) == 0.0f);
}

TEST_CASE("cellnoise: constant in a cell, uniform, unlike its neighbours") {
    Random r(5);
    int bins[64] = {};
    double neighbours = 0;
    const int n = 64000;
    for (int i = 0; i < n; ++i) {
        const Vec3f p = point3(r);
        const Vec3f corner{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
        const float v = cellnoise3d(p, 0);
        if (i % 100 == 0) {
            CHECK(v == cellnoise3d(corner, 0));
            CHECK(cellnoise2d({p.x, p.y}, 0) == cellnoise2d({corner.x, corner.y}, 0));
            CHECK(cellnoise3d_vec3(p, 0).x == v);
        }
        ++bins[static_cast<int>(v * 64)];
        neighbours += static_cast<double>((v - 0.5f) * (cellnoise3d_vec3(p, 0).y - 0.5f));
        neighbours +=
            static_cast<double>((v - 0.5f) * (cellnoise3d({p.x + 1, p.y, p.z}, 0) - 0.5f));
    }
    double chi2 = 0;
    for (const int count : bins) chi2 += std::pow(count - n / 64.0, 2) / (n / 64.0);
    CHECK(chi_square_p(chi2, 63) > 1e-4);
    CHECK(std::fabs(neighbours / n) < 4 * std::sqrt(2.0 / n) / 12);  // 4 sigma
}

TEST_CASE("worleynoise: without jitter the points are the centres") {
    Random r(6);
    for (int i = 0; i < 500; ++i) {
        const Vec3f p{r.between(-9, 9), r.between(-9, 9), r.between(-9, 9)};
        const auto off = [](float x) { return x - std::floor(x) - 0.5f; };
        const float x = off(p.x), y = off(p.y), z = off(p.z);
        const float flat = std::hypot(x, y), solid = std::sqrt(x * x + y * y + z * z);
        CHECK(worleynoise2d({p.x, p.y}, 0, 0).f1 == doctest::Approx(flat).epsilon(1e-4));
        CHECK(worleynoise3d(p, 0, 0).f1 == doctest::Approx(solid).epsilon(1e-4));
        const float next = std::hypot(1 - std::max(std::fabs(x), std::fabs(y)),
                                      std::min(std::fabs(x), std::fabs(y)));
        CHECK(worleynoise2d({p.x, p.y}, 0, 0).f2 == doctest::Approx(next).epsilon(1e-4));
    }
}

// A search that overlooked a point would jump where it turns to other cells.
TEST_CASE("worleynoise: distances change no faster than the point moves, across walls too") {
    Random r(7);
    const float e = 1e-3f, limit = 2 * e + 1e-5f;  // and rounding
    for (int i = 0; i < 30000; ++i) {
        const float x = std::floor(r.between(-40, 40)), y = r.between(-40, 40),
                    z = r.between(-4, 4);
        const Worley a = worleynoise2d({x - e, y}, 1, 0), b = worleynoise2d({x + e, y}, 1, 0);
        const Worley s = worleynoise3d({z, y, x - e}, 1, 0), t = worleynoise3d({z, y, x + e}, 1, 0);
        const bool smooth = std::fabs(a.f1 - b.f1) < limit && std::fabs(a.f2 - b.f2) < limit &&
                            std::fabs(s.f1 - t.f1) < limit && std::fabs(s.f2 - t.f2) < limit;
        const bool ordered = a.f1 <= a.f2 && s.f1 <= s.f2;
        if (!smooth || !ordered) FAIL_CHECK("at " << x << " " << y << " " << z);
    }
}

TEST_CASE("noise: the filter is nearer the footprint's mean than point or plain mean") {
    for (const float w : {0.25f, 0.5f, 1.0f, 1.5f, 2.5f}) {
        CAPTURE(w);
        const double wide = static_cast<double>(w);
        // The best fade errs by sqrt(b^2 - a^2), b^2 the variance left and a the fade: 0.02, 0.1,
        // 0.26, 0.35, 0.3 of the deviation at these widths; 8x8 points add up to 0.05.
        const double limit = 0.05 + 0.3 * std::min(wide, 1.2);
        const FilterError flat =
            filter_error(w, 0, [](Vec3f p, const Plane&, float a, float b, float v) {
                return in_plane_2d(noise2d, p, a, b, v);
            });
        CHECK(flat.filtered < limit);
        CHECK(flat.filtered < flat.plain_mean * 1.1);
        const FilterError solid =
            filter_error(w, 0, [](Vec3f p, const Plane& s, float a, float b, float v) {
                return noise3d(p + s.x * a + s.y * b, v);
            });
        CHECK(solid.filtered < limit);
        CHECK(solid.filtered < solid.plain_mean * 1.1);
        const FilterError sum =
            filter_error(w, 0, [](Vec3f p, const Plane& s, float a, float b, float v) {
                return fractal3d(p + s.x * a + s.y * b, {}, v);
            });
        CHECK(sum.filtered < limit + 0.05);
        const FilterError f1 =
            filter_error(w, 0.4294, [](Vec3f p, const Plane&, float a, float b, float v) {
                return worleynoise2d({p.x + a, p.y + b}, 1, v).f1;
            });
        CHECK(f1.filtered < limit);
    }
}

TEST_CASE("cellnoise: the filter is the box filter up to the width of a cell") {
    for (const float w : {0.1f, 0.5f, 1.0f}) {
        const FilterError e =
            filter_error(w, 0.5, [](Vec3f p, const Plane&, float a, float b, float v) {
                return in_plane_2d(cellnoise2d, p, a, b, v);
            });
        CHECK(e.filtered < 0.05);  // what 8x8 points err by across the edges of cells
    }
}

TEST_CASE("noise: the mean stays as the footprint grows, and is all that is left") {
    Random r(9);
    for (const float w : {0.3f, 1.0f, 1.7f, 3.0f}) {
        CAPTURE(w);
        Mean noise, cell, f1, f2, value;
        for (int i = 0; i < 20000; ++i) {
            const Vec3f p = point3(r);
            noise.add(static_cast<double>(fractal3d(p, {}, w)));
            cell.add(static_cast<double>(cellnoise3d(p, w)));
            const Worley v = worleynoise2d({p.x, p.y}, 1, w);
            f1.add(static_cast<double>(v.f1)), f2.add(static_cast<double>(v.f2));
            value.add(static_cast<double>(v.value));
        }
        // 4 sigma; the means of the distances are fitted to 1e-3.
        CHECK(std::fabs(noise.mean()) < 4 * noise.error() + 1e-9);
        CHECK(std::fabs(cell.mean() - 0.5) < 4 * cell.error() + 1e-9);
        CHECK(std::fabs(f1.mean() - 0.4294) < 4 * f1.error() + 1e-3);
        CHECK(std::fabs(f2.mean() - 0.6988) < 4 * f2.error() + 1e-3);
        CHECK(std::fabs(value.mean() - 0.5) < 4 * value.error() + 1e-9);
    }
    const Vec3f p{0.3f, 0.8f, 2.6f};
    for (const float w : {20.0f, 1e9f, kInfinity}) {
        CHECK(noise2d({p.x, p.y}, w) == 0.0f);
        CHECK(fractal3d_vec3(p, {.octaves = 9}, w) == Vec3f(0.0f));
        CHECK(cellnoise3d_vec3(p, w) == Vec3f(0.5f));
        CHECK(worleynoise3d(p, 1, w).f1 == doctest::Approx(0.5209f).epsilon(0.003));
    }
}

TEST_CASE("worleynoise: the mean distance is known for every jitter") {
    Random r(10);
    for (const float jitter : {0.0f, 0.4f, 0.8f}) {
        Mean flat, solid, second;
        for (int i = 0; i < 20000; ++i) {
            flat.add(static_cast<double>(worleynoise2d(point2(r), jitter, 0).f1));
            const Worley s = worleynoise3d(point3(r), jitter, 0);
            solid.add(static_cast<double>(s.f1)), second.add(static_cast<double>(s.f2));
        }
        const auto wide2 = worleynoise2d({}, jitter, 99), wide3 = worleynoise3d({}, jitter, 99);
        // 4 sigma and the fit.
        CHECK(std::fabs(flat.mean() - static_cast<double>(wide2.f1)) < 4 * flat.error() + 1e-3);
        CHECK(std::fabs(solid.mean() - static_cast<double>(wide3.f1)) < 4 * solid.error() + 1e-3);
        CHECK(std::fabs(second.mean() - static_cast<double>(wide3.f2)) < 4 * second.error() + 1e-3);
    }
}

TEST_CASE("noise: values are pinned, so that a changed hash is noticed") {
    const Vec3f p{1.3f, -2.7f, 0.4f};
    CHECK(noise2d({p.x, p.y}, 0) == doctest::Approx(-0.40475f).epsilon(1e-5));
    CHECK(noise3d(p, 0) == doctest::Approx(-0.0873653f).epsilon(1e-5));
    CHECK(fractal3d(p, {}, 0.1f) == doctest::Approx(0.0301587f).epsilon(1e-5));
    CHECK(cellnoise2d({p.x, p.y}, 0) == doctest::Approx(0.679229f).epsilon(1e-5));
    CHECK(cellnoise3d(p, 0) == doctest::Approx(0.181617f).epsilon(1e-5));
    CHECK(worleynoise2d({p.x, p.y}, 1, 0).f1 == doctest::Approx(0.300423f).epsilon(1e-5));
    CHECK(worleynoise3d(p, 1, 0).id == 1265937442u);
}

TEST_CASE("noise: any input gives a finite value, NaN in a place gives zero") {
    for (const float x : kHostile)
        for (const float y : kHostile)
            for (const float w : {0.0f, 0.5f, -1.0f, kNan, kInfinity}) {
                const Vec3f p{x, y, -x};
                const FractalParams wild{30, y, x};
                const Worley flat = worleynoise2d({x, y}, y, w), solid = worleynoise3d(p, x, w);
                const float sum = noise2d({x, y}, w) + cellnoise2d({x, y}, w) + flat.f1 + flat.f2 +
                                  flat.value + solid.f1 + solid.f2 + solid.value + noise3d(p, w);
                const Vec3f fractals = fractal3d_vec3(p, wild, w) + cellnoise3d_vec3(p, w);
                const bool finite = std::isfinite(sum) && is_finite(fractals) &&
                                    std::isfinite(fractal3d_lost(wild, w));
                if (!finite) FAIL_CHECK("at " << x << " " << y << ", width " << w);
            }
    CHECK(noise3d({kNan, 0.5f, 0.5f}, 0) == 0.0f);
    CHECK(cellnoise2d({0.5f, kNan}, 0) == 0.0f);
    CHECK(worleynoise3d({0.5f, 0.5f, kNan}, 1, 0).f1 == 0.0f);
    CHECK(cellnoise2d({3e9f, 0}, 0) == cellnoise2d({0x1p30f, 0}, 0));
    CHECK(std::isfinite(fractal2d({0.3f, 0.3f}, {-5, kNan, kNan}, 0)));
}
