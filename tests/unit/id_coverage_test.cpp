#include "renderer/film/id_coverage.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>

using namespace tessera;

namespace {

constexpr std::uint32_t kLimit = 1000;

struct Seen {
    std::size_t pixel;
    std::uint32_t key;
};

// Pixel i sees up to i * 12 things, small keys more often; so the last ones overflow.
std::vector<Seen> make_samples(std::size_t pixels, int count) {
    std::mt19937 random(5);
    const auto below = [&](std::size_t n) { return static_cast<std::uint32_t>(random() % n); };
    std::vector<Seen> samples;
    for (int i = 0; i < count; ++i) {
        const std::uint32_t pixel = below(pixels), range = 1 + pixel * 12;
        const std::uint32_t a = below(range), b = below(range);
        samples.push_back({pixel, std::min(a, b)});
    }
    return samples;
}

IdCoverage covered(std::size_t pixels, std::span<const Seen> samples) {
    IdCoverage coverage(pixels);
    for (const Seen& s : samples) coverage.add(s.pixel, s.key);
    return coverage;
}

void merge_all(IdCoverage& into, const IdCoverage& from) {
    for (std::size_t i = 0; i < into.pixels(); ++i) into.merge(i, from, i);
}

std::map<std::uint32_t, std::uint32_t> counts_of(const IdCoverage& coverage, std::size_t pixel) {
    std::array<KeyCount, IdCoverage::kMaxKeys> counts;
    const std::size_t n = coverage.counts(pixel, counts);
    std::map<std::uint32_t, std::uint32_t> out;
    for (std::size_t i = 0; i < n; ++i) out[counts[i].key] = counts[i].count;
    REQUIRE(out.size() == n);
    return out;
}

}  // namespace

TEST_CASE("id coverage: a pixel's samples are counted by key, and no others") {
    IdCoverage coverage(3);
    for (const std::uint32_t key : {7u, 2u, 7u, 9u, 7u, 2u}) coverage.add(1, key);
    CHECK(counts_of(coverage, 0).empty());
    CHECK(counts_of(coverage, 1) == std::map<std::uint32_t, std::uint32_t>{{2, 2}, {7, 3}, {9, 1}});
    CHECK(counts_of(coverage, 2).empty());
    CHECK(coverage.dropped(1) == 0);
}

TEST_CASE("id coverage: as many things as are promised are exact, of more the smallest keys are") {
    const auto max = static_cast<std::uint32_t>(IdCoverage::kMaxKeys);
    IdCoverage coverage(1);
    std::vector<std::uint32_t> keys(max + 5);
    std::iota(keys.begin(), keys.end(), 0);
    std::shuffle(keys.begin(), keys.end(), std::mt19937(3));
    for (const std::uint32_t key : keys) coverage.add(0, key, key + 1);
    const auto counts = counts_of(coverage, 0);
    REQUIRE(counts.size() == max);
    for (std::uint32_t key = 0; key < max; ++key) CHECK(counts.at(key) == key + 1);
    CHECK(coverage.dropped(0) == 5 * max + 15);  // max + 1 to max + 5
    CHECK(max >= 16);
}

TEST_CASE("id coverage: ranges merged in any order leave the state of the whole, overflow too") {
    constexpr std::size_t kPixels = 40;
    const std::vector<Seen> samples = make_samples(kPixels, 60000);
    const IdCoverageState whole = covered(kPixels, samples).state();
    REQUIRE(whole.dropped.size() > 5);
    REQUIRE(whole.dropped.size() < kPixels - 5);

    const std::span<const Seen> all(samples);
    const std::array<std::size_t, 5> ends{0, 100, 21000, 40000, 60000};
    std::array<int, 4> order{0, 1, 2, 3};
    do {
        IdCoverage merged(kPixels);
        for (const int part : order)
            merge_all(merged,
                      covered(kPixels, all.subspan(ends[part], ends[part + 1] - ends[part])));
        REQUIRE(merged.state() == whole);
    } while (std::next_permutation(order.begin(), order.end()));

    std::vector<Seen> shuffled = samples;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(11));
    CHECK(covered(kPixels, shuffled).state() == whole);
}

TEST_CASE("id coverage: no sample is lost uncounted") {
    constexpr std::size_t kPixels = 40;
    const std::vector<Seen> samples = make_samples(kPixels, 60000);
    const IdCoverage coverage = covered(kPixels, samples);
    std::vector<std::uint64_t> wanted(kPixels), found(kPixels);
    for (const Seen& s : samples) ++wanted[s.pixel];
    for (std::size_t i = 0; i < kPixels; ++i) {
        for (const auto& [key, count] : counts_of(coverage, i)) found[i] += count;
        found[i] += coverage.dropped(i);
    }
    CHECK(found == wanted);
}

TEST_CASE("id coverage: a saved state goes on as the original does") {
    constexpr std::size_t kPixels = 40;
    const std::vector<Seen> samples = make_samples(kPixels, 60000);
    const std::span<const Seen> all(samples);
    auto restored = IdCoverage::from(covered(kPixels, all.first(30000)).state(), kLimit);
    REQUIRE(restored);
    for (const Seen& s : all.subspan(30000)) restored->add(s.pixel, s.key);
    CHECK(restored->state() == covered(kPixels, samples).state());
}

TEST_CASE("id coverage: a state that contradicts itself is refused") {
    const std::vector<Seen> samples = make_samples(40, 60000);
    const IdCoverageState good = covered(40, samples).state();
    REQUIRE(IdCoverage::from(good, kLimit));
    const auto refused = [&](auto spoil, std::uint32_t limit = kLimit) {
        IdCoverageState bad = good;
        spoil(bad);
        return !IdCoverage::from(bad, limit);
    };
    const auto nothing = [](IdCoverageState&) {};
    CHECK(refused(nothing, 10));  // keys of another scene
    CHECK(refused([](auto& s) { s.keys.pop_back(); }));
    CHECK(refused([](auto& s) { s.keys.pop_back(), s.counts.pop_back(); }));
    CHECK(refused([](auto& s) { s.keys.push_back(1), s.counts.push_back(1); }));
    CHECK(refused([](auto& s) { s.sizes.pop_back(); }));
    CHECK(refused([](auto& s) { s.sizes.back() = 255; }));
    CHECK(refused([](auto& s) { s.counts[3] = 0; }));
    CHECK(refused([](auto& s) { std::swap(s.keys[s.keys.size() - 2], s.keys.back()); }));
    CHECK(refused([](auto& s) { s.dropped.pop_back(); }));
    CHECK(refused([](auto& s) { s.dropped_at[0] = 40; }));
    CHECK(refused([](auto& s) { s.dropped_at[0] = 1; }));
    CHECK(refused([](auto& s) { s.dropped_at[1] = s.dropped_at[0]; }));
}

TEST_CASE("id coverage: a pixel of one thing takes 16 bytes, whatever its neighbours take") {
    constexpr std::size_t kPixels = 10000;
    IdCoverage coverage(kPixels);
    for (std::size_t i = 0; i < kPixels; ++i) coverage.add(i, 3, 64);
    CHECK(coverage.bytes() == kPixels * 16);
    for (std::uint32_t key = 0; key < 3; ++key) coverage.add(5, key);
    CHECK(coverage.bytes() < kPixels * 16 + 100);
}
