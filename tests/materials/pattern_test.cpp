#include "materials/nodes/pattern.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "tests/support/random.h"
#include "tests/support/statistics.h"

using namespace tessera;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kHostile[] = {0.0f, -3.7f, 1e-40f, 3e9f, -1e30f, kInfinity, -kInfinity, kNan};
const Color kPaint{0.1f, 0.3f, 0.4f};

// Mean of f over the square of side w about p: 64x64 points, each anywhere in its part.
template <class F>
Color supersampled(Vec2f p, float w, F f) {
    Random r(11);
    Color sum;
    for (int i = 0; i < 4096; ++i) {
        const float x = (static_cast<float>(i & 63) + r.unit()) / 64.0f - 0.5f;
        const float y = (static_cast<float>(i >> 6) + r.unit()) / 64.0f - 0.5f;
        sum += f(Vec2f{p.x + w * x, p.y + w * y});
    }
    return sum * (1.0f / 4096.0f);
}

float distance(Color a, Color b) { return max_component(abs(a - b)); }

Color brick_relief(const Brick& b) { return {b.height, b.mortar, 0.0f}; }
Color cloth_seen(const Cloth& c) { return c.color * c.coverage; }
Color cloth_shares(const Cloth& c) {
    return {c.coverage, c.warp_share * c.coverage, (1.0f - c.warp_share) * c.coverage};
}
Color painted(const Rust& r) { return lerp(kPaint, r.color, r.mask); }
Color rust_relief(const Rust& r) { return {r.mask, r.height, r.roughness}; }
Color wood_relief(const Wood& w) { return {w.ring, w.height, w.roughness}; }

// Every pattern as one colour at a point of a slanted plane; footprints in units that suit all.
using View = Color (*)(Vec2f, float);
Vec3f on_plane(Vec2f p) { return {0.8f * p.x, p.y, 0.6f * p.x + 0.3f}; }
struct Named {
    std::string name;
    View view;
};
const Named kAll[] = {
    {"checker", [](Vec2f p, float w) { return checkerboard(p, {}, w); }},
    {"brick", [](Vec2f p, float w) { return brick(p, {}, w).color; }},
    {"brick relief", [](Vec2f p, float w) { return brick_relief(brick(p, {}, w)); }},
    {"wood", [](Vec2f p, float w) { return wood(on_plane(p), {}, w).color; }},
    {"wood relief", [](Vec2f p, float w) { return wood_relief(wood(on_plane(p), {}, w)); }},
    {"marble", [](Vec2f p, float w) { return marble(on_plane(p), {}, w).color; }},
    {"cloth", [](Vec2f p, float w) { return cloth_seen(cloth(p, {}, w)); }},
    {"cloth shares", [](Vec2f p, float w) { return cloth_shares(cloth(p, {}, w)); }},
    {"cloth height", [](Vec2f p, float w) { return Color(cloth(p, {}, w).height); }},
    {"rust", [](Vec2f p, float w) { return painted(rust(on_plane(p), {}, w)); }},
    {"rust relief", [](Vec2f p, float w) { return rust_relief(rust(on_plane(p), {}, w)); }},
};

ClothParams weave(int over, int under, int step) {
    ClothParams c;
    c.threads = {1.0f, 1.0f};
    c.over = over, c.under = under, c.step = step;
    return c;
}

}  // namespace

TEST_CASE("checkerboard: even cells have color2, uvtiling and uvoffset count cells") {
    const CheckerParams c{.uvtiling = {4, 2}, .uvoffset = {1, 0}};
    CHECK(checkerboard({0.125f, 0.25f}, c, 0) == Color(1.0f));  // cell -1, 0
    CHECK(checkerboard({0.375f, 0.25f}, c, 0) == Color(0.0f));
    CHECK(checkerboard({0.375f, 0.75f}, c, 0) == Color(1.0f));
    CHECK(checkerboard({-0.125f, -0.25f}, c, 0) == Color(1.0f));  // cell -2, -1
}

// A point errs by the edges that cross its part: 64x64 of them by 0.002 at most, in the root of the
// mean square. 1e-2 is 5 sigma.
TEST_CASE("checkerboard: the footprint is a box filter in closed form") {
    Random r(1);
    for (int i = 0; i < 40; ++i) {
        const CheckerParams c{.uvtiling = {r.between(-9, 9), r.between(0, 9)}};
        const Vec2f p{r.between(-5, 5), r.between(-5, 5)};
        const float w = 0.6f * r.unit();
        const Color mean = supersampled(p, w, [&](Vec2f q) { return checkerboard(q, c, 0); });
        CHECK(distance(checkerboard(p, c, w), mean) < 1e-2f);
    }
}

TEST_CASE("brick: the footprint is a box filter in closed form") {
    Random r(2);
    BrickParams b{.variation = 1.0f, .irregularity = 0.0f, .grain = 0.0f};
    for (int i = 0; i < 40; ++i) {
        b.size = {r.between(0.1f, 0.4f), r.between(0.05f, 0.2f)};
        b.mortar_width = 0.05f * r.unit();
        b.rounding = 0.05f * r.unit();
        b.row_offset = r.unit();
        const Vec2f p{r.between(-5, 5), r.between(-5, 5)};
        // Up to three bricks a side their colours too are exact.
        const float w = 2.9f * std::min(b.size.x, b.size.y) * r.unit();
        const Brick out = brick(p, b, w);
        CHECK(distance(brick_relief(out), supersampled(p, w, [&](Vec2f q) {
                           return brick_relief(brick(q, b, 0));
                       })) < 1e-2f);
        CHECK(distance(out.color,
                       supersampled(p, w, [&](Vec2f q) { return brick(q, b, 0).color; })) < 1e-2f);
    }
}

TEST_CASE("brick: every other row is shifted, the id is the brick's") {
    BrickParams b{.size = {1, 1}, .mortar_width = 0.2f, .irregularity = 0, .grain = 0};
    const auto at = [&](float x, float y) { return brick({x * 1.2f, y * 1.2f}, b, 0); };
    CHECK(at(0.5f, 0.5f).mortar == 0.0f);
    CHECK(at(0.0f, 0.5f).mortar == 1.0f);
    CHECK(at(0.0f, 1.5f).mortar == 0.0f);
    CHECK(at(0.5f, 1.5f).mortar == 1.0f);
    CHECK(at(0.3f, 1.0f).mortar == 1.0f);
    CHECK(at(0.2f, 0.2f).id == at(0.8f, 0.9f).id);
    CHECK(at(0.2f, 0.2f).id != at(1.2f, 0.2f).id);
    CHECK(at(0.2f, 0.2f).id != at(0.2f, 1.2f).id);
    CHECK(at(0.5f, 0.5f).height > 0.9f);
    CHECK(at(0.5f, 0.085f).height < at(0.5f, 0.09f).height);  // the bevel rises
    CHECK(at(0.0f, 0.5f).height < 0.1f);
}

TEST_CASE("cloth: the footprint is a box filter in closed form") {
    Random r(3);
    for (int i = 0; i < 40; ++i) {
        ClothParams c = weave(1 + i % 4, 1 + i % 3, 1 + i % 2);
        c.thread_width = r.between(0.3f, 1.0f);
        c.threads = {r.between(0.5f, 2), r.between(0.5f, 2)};
        c.variation = c.fibres = 0.0f;
        const Vec2f p{r.between(-50, 50), r.between(-50, 50)};
        const float w = 4.0f * r.unit();
        const Cloth out = cloth(p, c, w);
        CHECK(distance(cloth_shares(out), supersampled(p, w, [&](Vec2f q) {
                           return cloth_shares(cloth(q, c, 0));
                       })) < 1e-2f);
        CHECK(distance(cloth_seen(out), supersampled(p, w, [&](Vec2f q) {
                           return cloth_seen(cloth(q, c, 0));
                       })) < 1e-2f);
    }
}

TEST_CASE("cloth: plain, twill and satin lie as their counts say") {
    const auto warp = [](const ClothParams& c, int i, int j) {
        return cloth({static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f}, c, 0).is_warp;
    };
    for (int j = -7; j < 7; ++j)
        for (int i = -7; i < 7; ++i) {
            CHECK(warp(weave(1, 1, 1), i, j) == ((i + j) % 2 == 0));
            // A twill's diagonal: the next row does the same one thread further.
            CHECK(warp(weave(2, 2, 1), i, j) == warp(weave(2, 2, 1), i - 1, j + 1));
            // A satin's bindings do not touch.
            if (!warp(weave(4, 1, 2), i, j)) CHECK(warp(weave(4, 1, 2), i + 1, j));
            if (!warp(weave(4, 1, 2), i, j)) CHECK(warp(weave(4, 1, 2), i - 1, j + 1));
        }
}

TEST_CASE("cloth: thread normals lean outward, direction follows the thread") {
    ClothParams c = weave(1, 1, 1);
    c.thread_width = 0.8f;
    const Cloth top = cloth({0.5f, 0.5f}, c, 0), right = cloth({0.7f, 0.5f}, c, 0);
    CHECK(top.is_warp);
    CHECK(top.direction == Vec2f{0.0f, 1.0f});
    CHECK(top.normal.z == doctest::Approx(1.0f));
    CHECK(top.height == doctest::Approx(1.0f));
    CHECK(right.normal.x > 0.3f);
    CHECK(cloth({0.5f, 0.7f}, c, 0).normal.y > 0.1f);  // it bows down to the next crossing
    const Cloth weft = cloth({1.5f, 0.5f}, c, 0);
    CHECK(!weft.is_warp);
    CHECK(weft.direction == Vec2f{1.0f, 0.0f});
    CHECK(cloth({1.5f, 0.7f}, c, 0).normal.y > 0.3f);
    CHECK(cloth({0.0f, 0.0f}, c, 0).coverage == 0.0f);
    // The slope is the height's: a thread is as thick as relief says.
    const float e = 1e-3f, thick = 1.5f * c.relief * c.thread_width;
    const float rise =
        (cloth({0.6f + e, 0.6f}, c, 0).height - cloth({0.6f - e, 0.6f}, c, 0).height);
    const Vec3f n = cloth({0.6f, 0.6f}, c, 0).normal;
    CHECK(-n.x / n.z == doctest::Approx(rise / (2 * e) * thick).epsilon(0.01));
}

TEST_CASE("rust: spread is the share that is rusted") {
    Random r(4);
    for (const float spread : {0.05f, 0.2f, 0.5f, 0.8f}) {
        RustParams p;
        p.spread = spread;
        Mean mask;
        for (int i = 0; i < 4000; ++i) {
            const Vec3f at{r.between(-99, 99), r.between(-99, 99), r.between(-99, 99)};
            mask.add(static_cast<double>(rust(at, p, 0).mask));
        }
        // 4 sigma; and the sum's tails are shorter than a normal distribution's.
        CHECK(std::fabs(mask.mean() - static_cast<double>(spread)) < 4 * mask.error() + 0.015);
    }
    RustParams none, all;
    none.spread = 0.0f, all.spread = 1.0f;
    for (int i = 0; i < 200; ++i) {
        const Vec3f at{r.between(-99, 99), r.between(-99, 99), r.between(-99, 99)};
        CHECK(rust(at, none, r.unit()).mask == 0.0f);
        CHECK(rust(at, all, r.unit()).mask == 1.0f);
    }
}

TEST_CASE("wood: rings run round the axis and scale with their width") {
    const WoodParams fine{.distortion = 0, .ring_variation = 0, .grain = 0, .rays = 0};
    WoodParams coarse;
    coarse.ring_width = 4 * fine.ring_width;
    Random r(5);
    for (int i = 0; i < 500; ++i) {
        const Vec3f p{r.between(-1, 1), r.between(-1, 1), r.between(-1, 1)};
        const float w = 0.05f * r.unit(), radius = std::hypot(p.x, p.y);
        // Rounding of a radius of 50 rings, where a ring ends within a twentieth.
        CHECK(wood(p, fine, w).ring ==
              doctest::Approx(wood({radius, 0, 5}, fine, w).ring).epsilon(1e-3));
        CHECK(wood(p * 4.0f, coarse, 4 * w).color == wood(p, {}, w).color);
    }
}

TEST_CASE("marble: veins cover a part of the stone, thinner when sharp") {
    Random r(6);
    Mean soft, sharp;
    for (int i = 0; i < 3000; ++i) {
        const Vec3f p{r.between(-99, 99), r.between(-99, 99), r.between(-99, 99)};
        soft.add(static_cast<double>(marble(p, {.sharpness = 0}, 0).vein));
        sharp.add(static_cast<double>(marble(p, {.sharpness = 1}, 0).vein));
    }
    CHECK(soft.mean() > 0.2);
    CHECK(sharp.mean() < 0.25 * soft.mean());
    CHECK(sharp.mean() > 0.01);
}

// Per channel, of the mean itself, so that dark colours are held as close as bright ones: 3 %, and
// 4 sigma of both means. Roughness may have a mean near 0: no less than a tenth of its spread.
TEST_CASE("pattern: the mean stays as the footprint grows") {
    constexpr int kPoints = 32000, kWide = 8000;
    for (const Named& pattern : kAll) {
        CAPTURE(pattern.name);
        const auto means = [&](int n, float w) {
            std::array<Mean, 3> sum;
            Random at(7);
            for (int i = 0; i < n; ++i) {
                const Color c = pattern.view({at.between(-300, 300), at.between(-300, 300)}, w);
                for (int k = 0; k < 3; ++k) sum[k].add(static_cast<double>(c[k]));
            }
            return sum;
        };
        const auto points = means(kPoints, 0);
        for (const float w : {0.02f, 0.1f, 0.3f, 1.0f, 5.0f, 1e4f}) {
            CAPTURE(w);
            const auto wide = means(kWide, w);
            for (std::size_t k = 0; k < 3; ++k) {
                CAPTURE(k);
                const double mean = points[k].mean();
                const double spread = points[k].error() * std::sqrt(double{kPoints});
                const double noise = std::hypot(points[k].error(), wide[k].error());
                const double slack = 0.03 * std::max(std::fabs(mean), 0.1 * spread);
                CHECK(std::fabs(wide[k].mean() - mean) <= slack + 4 * noise);
            }
        }
    }
}

// Shimmer at the horizon would be what varies from point to point there.
TEST_CASE("pattern: far away only the mean is left") {
    Random r(12);
    for (const Named& pattern : kAll) {
        CAPTURE(pattern.name);
        const Color mean = pattern.view({}, 1e4f);
        float largest = 0.0f;
        for (int i = 0; i < 500; ++i) {
            const Vec2f p{r.between(-300, 300), r.between(-300, 300)};
            largest = std::max(largest, distance(pattern.view(p, r.between(10, 100)), mean));
        }
        // A box over n periods is off by at most one of them: 1/40 for a checker of 80 cells, in
        // each direction; everything else is nearer.
        CHECK(largest < 0.02f);
    }
}

TEST_CASE("pattern: the filter is near the mean of points") {
    for (const Named& pattern : kAll) {
        CAPTURE(pattern.name);
        const Color mean = pattern.view({}, 1e4f);
        for (const float w : {0.003f, 0.01f, 0.05f}) {
            CAPTURE(w);
            Random r(8);
            double error = 0, flat = 0;
            for (int i = 0; i < 40; ++i) {
                const Vec2f p{r.between(-30, 30), r.between(-30, 30)};
                Color sum;
                for (int k = 0; k < 256; ++k) {
                    const float x = (static_cast<float>(k & 15) + r.unit()) / 16.0f - 0.5f;
                    const float y = (static_cast<float>(k >> 4) + r.unit()) / 16.0f - 0.5f;
                    sum += pattern.view({p.x + w * x, p.y + w * y}, 0.0f) * (1.0f / 256);
                }
                error += static_cast<double>(length2(pattern.view(p, w) - sum)) / 40;
                flat += static_cast<double>(length2(mean - sum)) / 40;
            }
            // 16x16 points err by 0.01; noise that fades rather than blurs leaves the rest.
            CHECK(std::sqrt(error) < 0.02 + 0.3 * std::sqrt(flat));
        }
    }
}

// What would be seen as a line on a plane that runs to the horizon.
TEST_CASE("pattern: no switch as the footprint grows") {
    Random r(9);
    for (const Named& pattern : kAll) {
        CAPTURE(pattern.name);
        float largest = 0.0f;
        for (int i = 0; i < 12; ++i) {
            const Vec2f p{r.between(-30, 30), r.between(-30, 30)};
            Color last = pattern.view(p, 0.0f);
            for (float w = 1e-7f; w < 300.0f; w *= 1.02f) {
                const Color now = pattern.view(p, w);
                largest = std::max(largest, distance(now, last));
                last = now;
            }
        }
        // An edge that the growing box reaches comes in by 2% of the box's side at a time, two of
        // them in a corner; contrasts are at most 1.
        CHECK(largest < 0.04f);
    }
}

TEST_CASE("pattern: values are pinned, so that a change is noticed") {
    const Vec2f p{0.37f, -1.21f};
    CHECK(brick(p, {}, 0.01f).id == 3282592832u);
    CHECK(brick(p, {}, 0.01f).color.x == doctest::Approx(0.363669f).epsilon(1e-4));
    CHECK(wood(on_plane(p), {}, 0.001f).color.x == doctest::Approx(0.513121f).epsilon(1e-4));
    CHECK(marble(on_plane(p), {}, 0.01f).color.x == doctest::Approx(0.694985f).epsilon(1e-4));
    CHECK(cloth(p, {}, 0.01f).color.x == doctest::Approx(0.534481f).epsilon(1e-4));
    CHECK(rust(on_plane(p), {}, 0.01f).color.x == doctest::Approx(0.396125f).epsilon(1e-4));
}

TEST_CASE("pattern: any input gives finite values in range") {
    const auto unit = [](float x) { return x >= 0.0f && x <= 1.0f; };
    for (const float x : kHostile)
        for (const float y : kHostile)
            for (const float w : {0.0f, 0.01f, -1.0f, 1e30f, kInfinity, kNan}) {
                const Vec2f p{x, y};
                const Vec3f q{y, x, -y};
                const Brick b = brick(p,
                                      {.size = q.x > 0 ? Vec2f{y, x} : Vec2f{1, 1},
                                       .mortar_width = y,
                                       .row_offset = x,
                                       .rounding = x,
                                       .variation = y,
                                       .irregularity = x,
                                       .grain = x},
                                      w);
                const Cloth c = cloth(p,
                                      {.threads = {y, x},
                                       .over = -3,
                                       .under = 1 << 30,
                                       .step = -(1 << 30),
                                       .thread_width = x,
                                       .relief = y,
                                       .variation = x,
                                       .fibres = y},
                                      w);
                const Wood o = wood(q, {x, y, x, y, x, y}, w);
                const Marble m = marble(q, {x, y, x, y}, w);
                const Rust t = rust(q, {x, y, x, y}, w);
                const Color k = checkerboard(p, {.uvtiling = {y, x}, .uvoffset = {x, y}}, w);
                const bool good = is_finite(k + b.color + c.color + o.color + m.color + t.color) &&
                                  unit(b.height) && unit(b.mortar) && unit(c.coverage) &&
                                  unit(c.warp_share) && unit(c.height) && unit(o.height) &&
                                  unit(o.ring) && std::fabs(o.roughness) <= 0.15f && unit(m.vein) &&
                                  unit(t.mask) && unit(t.height) && unit(t.roughness) &&
                                  std::fabs(length2(c.normal) - 1.0f) < 1e-4f;
                if (!good) FAIL_CHECK("at " << x << " " << y << ", width " << w);
            }
}
