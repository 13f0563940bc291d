#include "materials/nodes/flakes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/statistics.h"

using namespace tessera;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Vec3f somewhere(Random& r) { return {r.between(-9, 9), r.between(-9, 9), r.between(-9, 9)}; }

// The microfacets of half vector h where these flakes are: how bright they would be.
double glint(const Flakes& f, Vec3f h) {
    const double a = std::pow(static_cast<double>(f.roughness), 4);
    const double c = static_cast<double>(dot(f.normal, h));
    if (c <= 0) return 0;
    const double k = c * c * (a - 1) + 1;
    return static_cast<double>(f.mask) * a / (3.14159265358979 * k * k);
}

// The greatest distance between the shares of sorted values in [0, 1) and even ones, as Kolmogorov
// has it; 1.95 / sqrt(n) is exceeded once in a thousand.
double unevenness(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    double most = 0;
    const double n = static_cast<double>(v.size());
    for (std::size_t i = 0; i < v.size(); ++i)
        most = std::max(most, std::fabs(v[i] - (static_cast<double>(i) + 0.5) / n));
    return most * std::sqrt(n);
}

}  // namespace

TEST_CASE("flakes: coverage is the share that is flake, for any footprint") {
    for (const float coverage : {0.0f, 0.1f, 0.5f, 0.9f, 1.0f}) {
        for (const float w : {0.0f, 0.005f, 0.02f, 1.0f}) {
            Random r(21);
            Mean mask;
            for (int i = 0; i < 4000; ++i)
                mask.add(static_cast<double>(
                    flakes(somewhere(r), {0, 0, 1}, {.coverage = coverage}, w).mask));
            // 4 sigma
            CHECK(std::fabs(mask.mean() - static_cast<double>(coverage)) <=
                  4 * mask.error() + 1e-5);
        }
    }
}

TEST_CASE("flakes: tilts are those of GGX microfacets, even all round, about any normal") {
    Random r(22);
    const FlakeParams f{.coverage = 1, .spread = 0.6f};
    for (const Vec3f n : {Vec3f{0, 0, 1}, normalize(Vec3f{-1, 0.3f, -2}), Vec3f{1, 0, 0}}) {
        const Vec3f s = normalize(cross(n, Vec3f{0.3f, 0.9f, 0.1f})), t = cross(n, s);
        std::vector<double> tilt, turn;
        for (int i = 0; i < 8000; ++i) {
            const Vec3f m = flakes(somewhere(r), n, f, 0).normal;
            const auto c = static_cast<double>(dot(m, n)), x = static_cast<double>(dot(m, s)),
                       y = static_cast<double>(dot(m, t));
            // The share of facets that are less tilted (Walter et al. 2007, eq. 35).
            const double tan2 = (x * x + y * y) / (c * c), a2 = std::pow(0.6, 4);
            tilt.push_back(tan2 / (a2 + tan2));
            turn.push_back(0.5 + std::atan2(y, x) / (2 * 3.14159265358979));
        }
        CHECK(unevenness(tilt) < 1.95);
        CHECK(unevenness(turn) < 1.95);
    }
}

TEST_CASE("flakes: a flake is of one piece, of about its size, and its own") {
    const FlakeParams f{.size = 0.02f, .coverage = 1};
    Random r(23);
    int changes = 0;
    Mean random;
    for (int i = 0; i < 400; ++i) {
        const Vec3f p = somewhere(r), d = Vec3f(r.direction());
        Flakes last = flakes(p, {0, 0, 1}, f, 0);
        random.add(static_cast<double>(last.random));
        for (int k = 1; k <= 20; ++k) {
            const Flakes now = flakes(p + d * (0.001f * static_cast<float>(k)), {0, 0, 1}, f, 0);
            CHECK((now.normal == last.normal) == (now.random == last.random));
            changes += now.random != last.random;
            last = now;
        }
    }
    // A line crosses 1.455 walls of a Voronoi cell per pitch for scattered points (Okabe et al.,
    // "Spatial Tessellations", 2000, table 5.4.2), somewhat fewer for jittered ones.
    CHECK(changes / 400.0 > 1.1);
    CHECK(changes / 400.0 < 1.5);
    CHECK(std::fabs(random.mean() - 0.5) < 4 * random.error());
}

// What a fleet of cars looks like must not change with its distance.
TEST_CASE("flakes: the mean glint stays as the footprint grows") {
    const FlakeParams f{.coverage = 0.6f, .roughness = 0.25f};
    for (const float degrees : {0.0f, 6.0f, 12.0f, 25.0f}) {
        const float a = degrees * kPi / 180.0f;
        const Vec3f h{std::sin(a), 0, std::cos(a)};
        double points = 0;
        for (const float w : {0.0f, 0.002f, 0.005f, 0.01f, 0.02f, 0.03f, 1.0f}) {
            CAPTURE(degrees);
            CAPTURE(w);
            Random r(24);
            Mean mean;
            for (int i = 0; i < 30000; ++i)
                mean.add(glint(flakes(somewhere(r), {0, 0, 1}, f, w), h));
            if (w == 0.0f) points = mean.mean();
            // That cubes of roughness add is true within 13%; 4 sigma of the points.
            CHECK(std::fabs(mean.mean() / points - 1) < 0.13 + 4 * mean.error() / points);
        }
    }
}

// A pixel's own samples lie within the footprint of the camera's: what they still see of single
// flakes is less than points would, and nearer to the truth than no flakes at all.
TEST_CASE("flakes: the filter is near the mean of points, and never noisier") {
    const FlakeParams f{.coverage = 0.6f, .roughness = 0.3f};
    const Vec3f up{0, 0, 1}, h = normalize(Vec3f{0.15f, 0, 1});
    const double flat = glint(flakes({}, up, f, 10.0f), h);
    double last = 1e30;
    for (const float w : {0.002f, 0.005f, 0.01f, 0.02f, 0.05f}) {
        CAPTURE(w);
        Random r(25);
        double error = 0, points = 0, seen = 0, from_flat = 0;
        const int n = 300;
        for (int i = 0; i < n; ++i) {
            const Vec3f p = somewhere(r);
            double sum = 0;
            for (int k = 0; k < 256; ++k) {
                const float x = (static_cast<float>(k & 15) + r.unit()) / 16.0f - 0.5f;
                const float y = (static_cast<float>(k >> 4) + r.unit()) / 16.0f - 0.5f;
                const double g = glint(flakes(p + Vec3f{w * x, w * y, 0}, up, f, 0.0f), h);
                sum += g / 256;
                if (k == 0) points += (g - flat) * (g - flat) / n;
            }
            const double g = glint(flakes(p, up, f, w), h);
            error += (g - sum) * (g - sum) / n;
            seen += (g - flat) * (g - flat) / n;
            from_flat += (sum - flat) * (sum - flat) / n;
        }
        CHECK(error < 1.001 * from_flat);
        CHECK(seen < points);
        CHECK(seen < last);
        last = seen;
    }
    CHECK(std::sqrt(last) < 1e-3 * flat);
}

TEST_CASE("flakes: no switch as the footprint grows") {
    Random r(26);
    float largest = 0;
    for (int i = 0; i < 40; ++i) {
        const Vec3f p = somewhere(r);
        Flakes last = flakes(p, {0, 0, 1}, {}, 0);
        for (float w = 1e-6f; w < 1; w *= 1.02f) {
            const Flakes now = flakes(p, {0, 0, 1}, {}, w);
            largest = std::max(
                {largest, length(now.normal - last.normal), std::fabs(now.mask - last.mask),
                 std::fabs(now.random - last.random), std::fabs(now.roughness - last.roughness)});
            last = now;
        }
    }
    // 2% of a footprint at a time; the roughness grows eight times as fast where no flake is near.
    CHECK(largest < 0.08f);
}

TEST_CASE("flakes: any input gives a unit normal and values in range") {
    constexpr float kHostile[] = {0.0f, -3.7f, 1e-40f, 3e9f, -1e30f, kInfinity, -kInfinity, kNan};
    const auto unit = [](float x) { return x >= 0.0f && x <= 1.0f; };
    for (const float x : kHostile)
        for (const float y : kHostile)
            for (const float z : kHostile) {
                const auto check = [&](const Flakes& f) {
                    CHECK(length(f.normal) == doctest::Approx(1.0f).epsilon(1e-5));
                    CHECK(unit(f.mask));
                    CHECK(unit(f.random));
                    CHECK(unit(f.roughness));
                };
                check(flakes({x, y, 1}, {0, 0, 1}, {}, z));
                check(flakes({1, 2, x}, {x, y, z}, {}, 0.01f));
                check(flakes({1, 2, 3}, {0, 1, 0}, {x, y, z, x}, 0.01f));
                check(flakes({1, 2, 3}, {0, 1, 0}, {0.01f, x, y, z}, x));
            }
}

TEST_CASE("flakes: values are pinned, so that a change is noticed") {
    const Flakes f = flakes({0.37f, -1.21f, 0.3f}, {0, 0, 1}, {.coverage = 1}, 0.003f);
    CHECK(f.random == doctest::Approx(0.432882f).epsilon(1e-4));
    CHECK(f.normal.x == doctest::Approx(0.174728f).epsilon(1e-4));
    CHECK(f.roughness == doctest::Approx(0.146277f).epsilon(1e-4));
}
