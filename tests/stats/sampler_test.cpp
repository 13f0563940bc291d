// The numbers behind every sample: nets, independence, and the maps and tables that they go
// through.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "renderer/core/distribution.h"
#include "renderer/core/sampler.h"
#include "renderer/core/warp.h"
#include "tests/support/sphere_chi_square.h"
#include "tests/support/statistics.h"

using namespace tessera;

namespace {

// True if every elementary interval 2^-a x 2^-(k-a) holds exactly one of the 2^k points from
// `first` on.
bool is_net(std::uint32_t seed, std::uint32_t pair, std::uint32_t first, int k) {
    const std::uint32_t n = 1u << k;
    for (int a = 0; a <= k; ++a) {
        std::vector<bool> full(n, false);
        for (std::uint32_t i = 0; i < n; ++i) {
            const Vec2f p = sample_pair(seed, first + i, pair);
            const auto x = static_cast<std::uint32_t>(p.x * static_cast<float>(1u << a));
            const auto y = static_cast<std::uint32_t>(p.y * static_cast<float>(1u << (k - a)));
            const std::size_t cell = (std::size_t(x) << (k - a)) + y;
            if (full[cell]) return false;
            full[cell] = true;
        }
    }
    return true;
}

double even_p(const std::vector<double>& counts, double expected) {
    return pooled_chi_square_p(counts, std::vector<double>(counts.size(), expected));
}

}  // namespace

TEST_CASE("sampler: every block of 2^k samples of a pair is a (0,k,2)-net") {
    for (std::uint32_t s = 0; s < 12; ++s) {
        const std::uint32_t seed =
            pixel_seed(static_cast<int>(37 * s), static_cast<int>(11 * s), s);
        for (const std::uint32_t pair :
             {dim::kFilter, dim::vertex(0, dim::kLight), dim::vertex(3, dim::kBsdf), 0x20008u}) {
            for (int k = 0; k <= 10; k += 2) {
                CAPTURE(s);
                CAPTURE(pair);
                CAPTURE(k);
                CHECK(is_net(seed, pair, 0, k));
                CHECK(is_net(seed, pair, 3u << k, k));
            }
        }
    }
}

TEST_CASE("sampler: sixteen lanes are sixteen single calls, all below one") {
    std::uint32_t seeds[kLanes];
    for (int l = 0; l < kLanes; ++l) seeds[l] = pixel_seed(l, 5, 9);
    for (std::uint32_t index = 0; index < 500; ++index) {
        SamplePairs pairs;
        sample_pairs(seeds, index, 21, pairs);
        for (int l = 0; l < kLanes; ++l) {
            REQUIRE(pairs.at(l) == sample_pair(seeds[l], index, 21));
            REQUIRE(pairs.x[l] >= 0.0f);
            REQUIRE(pairs.x[l] < 1.0f);
            REQUIRE(pairs.y[l] < 1.0f);
        }
    }
}

TEST_CASE("sampler: one sample per pixel is uniform over pixels") {
    // A first sample in each of 65 536 pixels: as good as independent numbers.
    std::vector<double> counts(64);
    Mean x, xy;
    for (int py = 0; py < 256; ++py) {
        for (int px = 0; px < 256; ++px) {
            const Vec2f p = sample_pair(pixel_seed(px, py, 4), 0, 9);
            ++counts[std::size_t(p.x * 8) * 8 + std::size_t(p.y * 8)];
            x.add(static_cast<double>(p.x));
            xy.add((static_cast<double>(p.x) - 0.5) * (static_cast<double>(p.y) - 0.5));
        }
    }
    CHECK(even_p(counts, 1024) > 0.001);
    CHECK(std::fabs(x.mean() - 0.5) < 4 * x.error());
    CHECK(x.variance() == doctest::Approx(1.0 / 12).epsilon(0.02));
    CHECK(std::fabs(xy.mean()) < 4 * xy.error());
}

TEST_CASE("sampler: pairs, neighbours and seeds are independent of each other") {
    // Correlation of 256 stratified values, over 2000 pixels: its mean must vanish and its spread
    // be that of chance.
    struct Link {
        std::uint32_t pair_a, pair_b;
        int dx;
        std::uint64_t seed_b;
    };
    const Link links[] = {{8, 9, 0, 0},  {8, 10, 0, 0}, {9, 10, 0, 0}, {0, 8, 0, 0},
                          {8, 16, 0, 0}, {8, 8, 1, 0},  {8, 8, 0, 1},  {10, 18, 0, 0}};
    for (const Link& link : links) {
        CAPTURE(link.pair_a);
        CAPTURE(link.pair_b);
        CAPTURE(link.dx);
        Mean xx, xy;
        for (int pixel = 0; pixel < 2000; ++pixel) {
            const std::uint32_t a = pixel_seed(pixel * 3, 7, 0),
                                b = pixel_seed(pixel * 3 + link.dx, 7, link.seed_b);
            double cxx = 0, cxy = 0;
            constexpr int kCount = 256;
            for (std::uint32_t i = 0; i < kCount; ++i) {
                const Vec2f p = sample_pair(a, i, link.pair_a), q = sample_pair(b, i, link.pair_b);
                cxx += (static_cast<double>(p.x) - 0.5) * (static_cast<double>(q.x) - 0.5);
                cxy += (static_cast<double>(p.x) - 0.5) * (static_cast<double>(q.y) - 0.5);
            }
            xx.add(12 * cxx / kCount);
            xy.add(12 * cxy / kCount);
        }
        CHECK(std::fabs(xx.mean()) < 4 * xx.error());
        CHECK(std::fabs(xy.mean()) < 4 * xy.error());
        // Independent permutations of 256 strata: standard deviation 1/16.
        CHECK(std::sqrt(xx.variance()) == doctest::Approx(1.0 / 16).epsilon(0.15));
        CHECK(std::sqrt(xy.variance()) == doctest::Approx(1.0 / 16).epsilon(0.15));
    }
}

TEST_CASE("sampler: scrambled points integrate without bias") {
    // Sixteen samples of a smooth function in 4000 pixels; 4 sigma of the mean.
    Mean mean;
    for (int pixel = 0; pixel < 4000; ++pixel) {
        double sum = 0;
        for (std::uint32_t i = 0; i < 16; ++i) {
            const Vec2f p = sample_pair(pixel_seed(pixel, 1, 2), i, 8);
            sum += std::exp(static_cast<double>(p.x)) * static_cast<double>(p.y) *
                   static_cast<double>(p.y);
        }
        mean.add(sum / 16);
    }
    CHECK(std::fabs(mean.mean() - (std::exp(1.0) - 1) / 3) < 4 * mean.error());
    CHECK(mean.error() < 4e-4);  // stratified: plain random numbers would have 1.3e-3
}

TEST_CASE("alias table: indices come as often as their weights say, the remainder is even") {
    const std::vector<double> weights{1, 0, 5, 0.25, 3, 0, 10, 1e-3, 2};
    const AliasTable table(weights);
    constexpr int kTries = 1 << 20;
    Random n(3);
    std::vector<double> observed(weights.size()), expected, remainder(32);
    for (double w : weights) expected.push_back(w / 21.251 * kTries);
    for (int i = 0; i < kTries; ++i) {
        const AliasTable::Pick p = table.sample(n.unit());
        ++observed[p.index];
        ++remainder[std::size_t(p.remainder * 32)];
        REQUIRE(p.probability == doctest::Approx(weights[p.index] / 21.251));
    }
    CHECK(observed[1] == 0);
    CHECK(pooled_chi_square_p(observed, expected) > 0.001);
    CHECK(even_p(remainder, kTries / 32.0) > 0.001);
}

TEST_CASE("distribution: points fall into cells by weight, evenly within, and pdf says so") {
    constexpr int kW = 7, kH = 5, kTries = 1 << 19;
    std::vector<double> weights;
    double sum = 0;
    Random n(8);
    for (int i = 0; i < kW * kH; ++i)
        weights.push_back(i % 6 == 2 ? 0.0 : (i == 17 ? 60.0 : static_cast<double>(n.unit()))),
            sum += weights.back();
    const Distribution2D table(kW, kH, weights);
    std::vector<double> observed(weights.size()), expected, within(16);
    for (double w : weights) expected.push_back(w / sum * kTries);
    for (int i = 0; i < kTries; ++i) {
        const auto s = table.sample(n.pair());
        const float x = s.uv.x * kW, y = s.uv.y * kH;
        ++observed[std::size_t(y) * kW + std::size_t(x)];
        ++within[std::size_t((x - std::floor(x)) * 4) * 4 + std::size_t((y - std::floor(y)) * 4)];
        REQUIRE(s.pdf ==
                doctest::Approx(weights[std::size_t(y) * kW + std::size_t(x)] / sum * kW * kH)
                    .epsilon(1e-4));
        REQUIRE(table.pdf(s.uv) == doctest::Approx(static_cast<double>(s.pdf)).epsilon(1e-4));
    }
    CHECK(pooled_chi_square_p(observed, expected) > 0.001);
    CHECK(even_p(within, kTries / 16.0) > 0.001);
    CHECK(table.mean() == doctest::Approx(sum / (kW * kH)));
}

TEST_CASE("warps: each makes the density that its comment claims") {
    constexpr double kPiD = 3.14159265358979;
    SphereTest test;
    test.seed = 12;
    test.charts = {{{0, 0, 1}, true}, {{0, 0, -1}, true}};
    const auto unit = [](Vec3f w) { return std::optional(normalize(Vec3d(w))); };
    const auto p_of = [&](auto warp, auto pdf) {
        return sphere_chi_square(
                   test, [&](Random& n) { return unit(warp(n.pair())); }, pdf)
            .p;
    };
    CHECK(p_of([](Vec2f u) { return warp_cosine(u); },
               [](Vec3d w) { return std::max(0.0, w.z / kPiD); }) > 0.001);
    CHECK(p_of([](Vec2f u) { return warp_sphere(u); }, [](Vec3d) { return 0.25 / kPiD; }) > 0.001);
    for (const float one_minus_cos : {1e-5f, 0.1f, 0.9f}) {
        const double k = static_cast<double>(one_minus_cos);
        CHECK(p_of([&](Vec2f u) { return warp_cone(u, one_minus_cos); },
                   [&](Vec3d w) { return 1 - w.z / length(w) < k ? 0.5 / (kPiD * k) : 0.0; }) >
              0.001);
    }
    // Discs, lifted to the hemisphere: uniform on the disc is cosine above it. Triangles by
    // barycentric strips.
    const auto lift = [](Vec2f d) { return Vec3f{d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)}; };
    CHECK(p_of([&](Vec2f u) { return lift(warp_disc(u)); },
               [](Vec3d w) { return std::max(0.0, w.z / kPiD); }) > 0.001);
    CHECK(p_of([&](Vec2f u) { return lift(warp_disc_concentric(u)); },
               [](Vec3d w) { return std::max(0.0, w.z / kPiD); }) > 0.001);
    Random n(21);
    std::vector<double> strips(24);
    constexpr int kTries = 1 << 18;
    for (int i = 0; i < kTries; ++i) {
        const Vec2f b = warp_triangle(n.pair());
        REQUIRE(b.x + b.y <= 1.000001f);
        const double c[3] = {
            static_cast<double>(b.x), static_cast<double>(b.y),
            std::max(0.0, 1 - static_cast<double>(b.x) - static_cast<double>(b.y))};
        // 1 - (1 - c)^2 is uniform for each barycentric coordinate.
        for (std::size_t k = 0; k < 3; ++k)
            ++strips[k * 8 +
                     std::min<std::size_t>(7, std::size_t((1 - (1 - c[k]) * (1 - c[k])) * 8))];
    }
    for (std::size_t k = 0; k < 3; ++k)
        CHECK(even_p({strips.begin() + long(k * 8), strips.begin() + long(k * 8 + 8)},
                     kTries / 8.0) > 0.001);
}

TEST_CASE("sampler: the first of a pair alone is the first of the pair, one lane or all") {
    std::uint32_t seeds[kLanes];
    for (std::uint32_t i = 0; i < kLanes; ++i) seeds[i] = pixel_seed(static_cast<int>(i), 3, 7);
    for (std::uint32_t index = 0; index < 300; ++index) {
        SamplePairs pairs;
        float singles[kLanes];
        sample_pairs(seeds, index, 11, pairs);
        sample_singles(seeds, index, 11, singles);
        for (int i = 0; i < kLanes; ++i) {
            REQUIRE(singles[i] == pairs.x[i]);
            REQUIRE(sample_single(seeds[i], index, 11) == pairs.x[i]);
            REQUIRE(sample_pair(seeds[i], index, 11) == pairs.at(i));
        }
    }
}

TEST_CASE("power heuristic: the two weights of a direction add to one") {
    Random n(2);
    for (int i = 0; i < 1000; ++i) {
        const float a = std::exp(n.between(-20, 20)), b = std::exp(n.between(-20, 20));
        CHECK(mis_power(a, b) + mis_power(b, a) == doctest::Approx(1).epsilon(1e-5));
    }
    CHECK(mis_power(1, 0) == 1.0f);
    CHECK(mis_power(0, 1) == 0.0f);
}
