// Parts of a picture: what they share and what they lack.
#include <doctest/doctest.h>

#include <set>
#include <tuple>

#include "renderer/film/film_parts.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

using Cells = std::set<std::tuple<int, int, int>>;

Cells cells_of(const SampleBox& b) {
    Cells out;
    for (int s = b.first; s < b.last; ++s)
        for (int y = b.window.y0; y < b.window.y1; ++y)
            for (int x = b.window.x0; x < b.window.x1; ++x) out.insert({s, y, x});
    return out;
}

SampleBox random_box(Random& random, int side) {
    const auto below = [&](int n) {
        return static_cast<int>(random.bits() % static_cast<std::uint64_t>(n));
    };
    const auto pair = [&] {
        const int a = below(side);
        return std::pair{a, a + 1 + below(side - a)};
    };
    const auto [x0, x1] = pair();
    const auto [y0, y1] = pair();
    const auto [s0, s1] = pair();
    return {{x0, y0, x1, y1}, s0, s1};
}

}  // namespace

TEST_CASE("film parts: what is missing is exactly the cells that no part has, each once") {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        const SampleBox whole{{0, 0, 6, 6}, 0, 6};
        std::vector<SampleBox> parts;
        for (int i = 0; i < round % 7; ++i) parts.push_back(random_box(random, 7));
        Cells left = cells_of(whole);
        for (const SampleBox& p : parts)
            for (const auto& c : cells_of(p)) left.erase(c);
        Cells found;
        std::size_t sum = 0;
        for (const SampleBox& hole : missing(whole, parts)) {
            const Cells cells = cells_of(hole);
            sum += cells.size();
            found.insert(cells.begin(), cells.end());
        }
        REQUIRE(found == left);
        REQUIRE(sum == left.size());
    }
}

TEST_CASE("film parts: neighbours do not overlap, one shared sample of one pixel does") {
    const SampleBox a{{0, 0, 8, 8}, 0, 4}, right{{8, 0, 16, 8}, 0, 4}, later{{0, 0, 8, 8}, 4, 8};
    CHECK(!overlap(std::vector{a, right, later}));
    const SampleBox corner{{7, 7, 9, 9}, 3, 5};
    const auto both = overlap(std::vector{right, later, a, corner});
    REQUIRE(both.has_value());
    CHECK(*both == std::pair<std::size_t, std::size_t>{0, 3});
    CHECK(to_string(intersection(a, corner)) == "samples 3:4 of pixels 7,7,8,8");
    CHECK(bounds(std::vector{right, later}) == SampleBox{{0, 0, 16, 8}, 0, 8});
    CHECK(is_empty(bounds({})));
}
