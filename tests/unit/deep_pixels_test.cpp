#include "renderer/film/deep_pixels.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <random>

using namespace tessera;

namespace {

struct Seen {
    std::size_t pixel;
    float z;  // 0: nothing
    Color radiance;
};

// Pixel i sees depths over a range that grows with i, so that the last ones overflow. Radiances are
// multiples of 1/8: their sums are exact in any order.
std::vector<Seen> make_samples(std::size_t pixels, int count) {
    std::mt19937 random(5);
    std::vector<Seen> samples;
    for (int i = 0; i < count; ++i) {
        const std::size_t pixel = random() % pixels;
        const auto eighths = [&] { return static_cast<float>(random() % 100) * 0.125f; };
        const float reach = static_cast<float>(pixel) * 0.02f;
        const float z =
            random() % 5 == 0 ? 0.0f : 3 + reach * static_cast<float>(random() % 1000) * 1e-3f;
        samples.push_back({pixel, z, {eighths(), eighths(), eighths()}});
    }
    return samples;
}

DeepPixels seen(std::size_t pixels, std::span<const Seen> samples) {
    DeepPixels deep(pixels);
    for (const Seen& s : samples) {
        if (s.z > 0)
            deep.add(s.pixel, s.z, s.radiance);
        else
            deep.add_background(s.pixel, s.radiance);
    }
    return deep;
}

void merge_all(DeepPixels& into, const DeepPixels& from) {
    for (std::size_t i = 0; i < into.pixels(); ++i) into.merge(i, from, i);
}

std::vector<DeepSample> samples_of(const DeepPixels& deep, std::size_t pixel, std::uint32_t n) {
    std::vector<DeepSample> out;
    const std::size_t count = deep.put(pixel, n, out);
    CHECK(count == out.size());
    return out;
}

}  // namespace

TEST_CASE("deep pixels: depths are apart, near ones are one, shares are of all samples") {
    DeepPixels deep(2);
    deep.add(1, 2.0f, {1, 0, 0});
    deep.add(1, 2.0005f, {3, 0, 0});  // within the tolerance of 0.1 %
    deep.add(1, 2.1f, {0, 4, 0});
    deep.add_background(1, {0, 0, 8});
    CHECK(samples_of(deep, 0, 4).empty());
    const auto samples = samples_of(deep, 1, 4);
    REQUIRE(samples.size() == 3);
    CHECK(samples[0].z == 2.0f);
    CHECK(samples[0].alpha == 0.5);
    CHECK(samples[0].rgb[0] == 1.0f);
    CHECK(samples[1].z == 2.1f);
    CHECK(samples[1].alpha == 0.25);
    CHECK(samples[1].rgb[1] == 1.0f);
    CHECK(samples[2].z == kDeepBackground);
    CHECK(samples[2].alpha == 0);
    CHECK(samples[2].rgb[2] == 2.0f);
}

TEST_CASE("deep pixels: a joined sample spans at most the tolerance, wherever the steps lie") {
    for (int i = 0; i < 200; ++i) {
        const float z = 1.0f + static_cast<float>(i) * 0.00771f;
        DeepPixels deep(1);
        deep.add(0, z, Color(1.0f));
        deep.add(0, z * 1.0015f, Color(1.0f));
        CHECK(samples_of(deep, 0, 2).size() == 2);
        deep = DeepPixels(1);
        deep.add(0, z, Color(1.0f));
        deep.add(0, z * 1.0002f, Color(1.0f));
        CHECK(samples_of(deep, 0, 2).size() == 1);
        deep = DeepPixels(1);
        for (int k = 0; k <= 20; ++k)
            deep.add(0, z * (1 + 1e-4f * static_cast<float>(k)), Color(1.0f));
        CHECK(samples_of(deep, 0, 21)[0].alpha < 11.5 / 21);  // 0.1 % are 10 of them
    }
}

TEST_CASE("deep pixels: depths below 0, at 0 and out of range keep their order") {
    DeepPixels deep(1);
    for (const float z : {0.0f, -0.0f, 3.0f, -2.0f, 3e38f, 0.0f, -5.0f})
        deep.add(0, z, Color(1.0f));
    deep.add_background(0, Color(1.0f));
    const auto samples = samples_of(deep, 0, 8);
    REQUIRE(samples.size() == 6);
    const bool sorted = std::is_sorted(samples.begin(), samples.end(),
                                       [](const auto& a, const auto& b) { return a.z < b.z; });
    CHECK(sorted);
    CHECK(samples[0].z == -5.0f);
    CHECK(samples[4].z < kDeepBackground);  // 3e38 is in front of the background
    CHECK(samples[4].alpha == 0.125);
    CHECK(samples[5].alpha == 0);
}

TEST_CASE("deep pixels: ranges merged in any order leave the state of the whole, crowds too") {
    constexpr std::size_t kPixels = 40;
    const std::vector<Seen> samples = make_samples(kPixels, 20000);
    const DeepPixels all_at_once = seen(kPixels, samples);
    const DeepPixelsState whole = all_at_once.state();
    REQUIRE(all_at_once.crowded() > 5);
    REQUIRE(all_at_once.crowded() < kPixels - 1);

    const std::span<const Seen> all(samples);
    const std::array<std::size_t, 5> ends{0, 100, 7000, 13000, 20000};
    std::array<int, 4> order{0, 1, 2, 3};
    do {
        DeepPixels merged(kPixels);
        for (const int part : order)
            merge_all(merged, seen(kPixels, all.subspan(ends[part], ends[part + 1] - ends[part])));
        REQUIRE(merged.state() == whole);
    } while (std::next_permutation(order.begin(), order.end()));

    std::vector<Seen> shuffled = samples;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(11));
    CHECK(seen(kPixels, shuffled).state() == whole);
}

TEST_CASE("deep pixels: nothing is lost, however crowded") {
    constexpr std::size_t kPixels = 40;
    const std::vector<Seen> samples = make_samples(kPixels, 20000);
    const DeepPixels deep = seen(kPixels, samples);
    for (std::size_t i = 0; i < kPixels; ++i) {
        double hits = 0, red = 0, n = 0;
        for (const Seen& s : samples) {
            if (s.pixel != i) continue;
            ++n;
            hits += s.z > 0;
            red += static_cast<double>(s.radiance.x);
        }
        double alpha = 0, sum = 0;
        const auto found = samples_of(deep, i, static_cast<std::uint32_t>(n));
        CHECK(found.size() <= DeepPixels::kMaxDepths + 1);
        for (const DeepSample& s : found) {
            alpha += s.alpha;
            sum += static_cast<double>(s.rgb[0]);
        }
        CHECK(alpha == doctest::Approx(hits / n).epsilon(1e-12));
        CHECK(sum == doctest::Approx(red / n).epsilon(1e-6));  // floats
    }
}

TEST_CASE("deep pixels: a saved state goes on as the original does") {
    constexpr std::size_t kPixels = 40;
    const std::vector<Seen> samples = make_samples(kPixels, 20000);
    const std::span<const Seen> all(samples);
    auto restored = DeepPixels::from(seen(kPixels, all.first(9000)).state());
    REQUIRE(restored);
    merge_all(*restored, seen(kPixels, all.subspan(9000)));
    CHECK(restored->state() == seen(kPixels, samples).state());
}

TEST_CASE("deep pixels: a state that contradicts itself is refused") {
    const DeepPixelsState good = seen(40, make_samples(40, 20000)).state();
    REQUIRE(DeepPixels::from(good));
    const auto refused = [&](auto spoil) {
        DeepPixelsState bad = good;
        spoil(bad);
        return !DeepPixels::from(bad);
    };
    CHECK(refused([](auto& s) { s.keys.pop_back(); }));
    CHECK(refused([](auto& s) { s.sizes.back() = 255; }));
    CHECK(refused([](auto& s) { --s.sizes.back(); }));
    CHECK(refused([](auto& s) { s.levels.pop_back(); }));
    CHECK(refused([](auto& s) { s.levels.back() = 200; }));
    CHECK(refused([](auto& s) { ++s.levels.back(); }));  // depths are in other steps
    CHECK(refused([](auto& s) { s.counts[3] = 0; }));
    CHECK(refused([](auto& s) { s.depths[4] = NAN; }));
    CHECK(refused([](auto& s) { s.depths[4] = -1; }));
    CHECK(refused([](auto& s) { s.sums[9] = INFINITY; }));
    CHECK(refused([](auto& s) { s.keys[1] = s.keys[0]; }));
}

TEST_CASE("deep pixels: a pixel of one depth takes 96 bytes, one of very many at most 4 KiB") {
    constexpr std::size_t kPixels = 1000;
    DeepPixels deep(kPixels);
    for (std::size_t i = 0; i < kPixels; ++i) {
        deep.add(i, 3, Color(1.0f));
        deep.add(i, 3, Color(1.0f));
    }
    CHECK(deep.bytes() == kPixels * 96);
    for (int i = 0; i < 100000; ++i) deep.add(0, static_cast<float>(i + 1), Color(1.0f));
    CHECK(deep.bytes() <= kPixels * 96 + 4096);
}
