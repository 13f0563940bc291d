// Faces cut into small ones meet without a crack, whatever the rates of their edges.

#include "renderer/geometry/dice.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "tests/support/cages.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

// A long strip and a cage with every kind of corner; the last has two charts on one edge.
std::vector<MeshDesc> cages() {
    MeshDesc seam = grid_cage(2);
    seam.uv_index = seam.position_index;
    for (std::size_t c = 4; c < 8; ++c) seam.uv_index[c] += 9;
    seam.uvs.insert(seam.uvs.end(), seam.uvs.begin(), seam.uvs.begin() + 18);
    return {cube_cage(),  pyramid_cage(), star_cage(6), star_cage(2),
            grid_cage(3), sphere_cage(2), seam};
}

std::vector<int> random_rates(const Cage& cage, std::uint32_t seed, int most) {
    Random random(seed);
    std::vector<int> rates;
    for (std::size_t e = 0; e < cage.edges.size(); ++e)
        rates.push_back(1 + static_cast<int>(random.between(0, static_cast<float>(most))));
    make_even(cage, rates);
    return rates;
}

using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

// How often each edge of a triangle, in its direction, is met; by place.
std::map<DirectedEdge, int> edges_of(const Diced& d) {
    std::map<DirectedEdge, int> met;
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const std::uint32_t p[3] = {d.place[a], d.place[b], d.place[c]};
        for (int k = 0; k < 3; ++k) ++met[{p[k], p[(k + 1) % 3]}];
    };
    for (std::size_t t = 0; t < d.triangles.size(); t += 3)
        triangle(d.triangles[t], d.triangles[t + 1], d.triangles[t + 2]);
    for (std::size_t q = 0; q < d.quads.size(); q += 4) {
        triangle(d.quads[q], d.quads[q + 1], d.quads[q + 3]);
        triangle(d.quads[q + 2], d.quads[q + 3], d.quads[q + 1]);
    }
    return met;
}

// Pieces of the cage's edges that only one face has.
std::size_t open_pieces(const Cage& cage, const std::vector<int>& rates) {
    std::vector<int> faces(cage.edges.size(), 0);
    for (const std::uint32_t e : cage.edge) ++faces[e];
    std::size_t sum = 0;
    for (std::size_t e = 0; e < faces.size(); ++e)
        if (faces[e] == 1) sum += static_cast<std::size_t>(rates[e]);
    return sum;
}

// Twice the area of a triangle in its patch, where it lies in one.
double area_in_patch(const DiceSite& a, const DiceSite& b, const DiceSite& c) {
    return static_cast<double>((b.s - a.s) * (c.t - a.t) - (c.s - a.s) * (b.t - a.t));
}

}  // namespace

TEST_CASE("dice: every edge inside has a triangle on either side, at rates as they come") {
    std::uint32_t seed = 1;
    for (const MeshDesc& mesh : cages()) {
        const Cage cage = make_cage(mesh, false);
        for (const int most : {1, 2, 3, 9, 40}) {
            const std::vector<int> rates = random_rates(cage, seed++, most);
            const Diced d = dice(cage, rates);
            const std::map<DirectedEdge, int> met = edges_of(d);
            std::size_t open = 0, wrong = 0;
            for (const auto& [edge, count] : met) {
                wrong += edge.first == edge.second || count != 1;
                open += !met.contains({edge.second, edge.first});
            }
            CHECK(wrong == 0);
            CHECK(open == open_pieces(cage, rates));
            const std::size_t made = d.triangles.size() / 3 + d.quads.size() / 2;
            CHECK(made == diced_triangles(cage, rates));
            CHECK(3 * made == met.size());
        }
    }
}

TEST_CASE("dice: a face is filled once: its pieces add up to it and none is turned over") {
    // A single quad, so that all sites are of one patch.
    const Cage cage = make_cage(grid_cage(1), false);
    std::uint32_t seed = 77;
    for (const int most : {1, 2, 3, 5, 17}) {
        const std::vector<int> rates = random_rates(cage, seed++, most);
        const Diced d = dice(cage, rates);
        double sum = 0;
        const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            const double area = area_in_patch(d.sites[a], d.sites[b], d.sites[c]);
            CHECK(area > 0);
            sum += 0.5 * area;
        };
        for (std::size_t t = 0; t < d.triangles.size(); t += 3)
            add(d.triangles[t], d.triangles[t + 1], d.triangles[t + 2]);
        for (std::size_t q = 0; q < d.quads.size(); q += 4) {
            add(d.quads[q], d.quads[q + 1], d.quads[q + 3]);
            add(d.quads[q + 2], d.quads[q + 3], d.quads[q + 1]);
        }
        CHECK(sum == doctest::Approx(1).epsilon(1e-5));  // sites are floats
    }
}

TEST_CASE("dice: equal rates make quads alone, each vertex once") {
    const Cage cage = make_cage(cube_cage(), false);
    const Diced d = dice(cage, std::vector<int>(12, 8));
    CHECK(d.triangles.empty());
    CHECK(d.quads.size() == 4 * 6 * 64);
    CHECK(d.sites.size() == 8 + 12 * 7 + 6 * 49);
}

TEST_CASE("dice: vertices of a texture seam share their place and nothing else is doubled") {
    const MeshDesc seam = cages().back();
    const Cage cage = make_cage(seam, false);
    const Diced d = dice(cage, std::vector<int>(cage.edges.size(), 4));
    // The odd quad's two inner edges of 4 pieces: 9 places with two vertices each.
    CHECK(d.sites.size() == d.places - 1 + 9);  // places counts the padding of the cage's
    std::map<std::uint32_t, int> vertices;
    for (const std::uint32_t p : d.place) ++vertices[p];
    CHECK(std::count_if(vertices.begin(), vertices.end(),
                        [](const auto& v) { return v.second == 2; }) == 9);
}

TEST_CASE("cage: positions that a file repeats are one place, faces without area are left out") {
    MeshDesc mesh = grid_cage(2);
    MeshDesc apart = mesh;
    apart.positions.clear();
    apart.position_index.clear();
    for (const std::uint32_t i : mesh.position_index) {
        apart.position_index.push_back(static_cast<std::uint32_t>(apart.position_index.size()));
        for (std::size_t k = 0; k < 3; ++k)
            apart.positions.push_back(mesh.positions[3 * std::size_t(i) + k]);
    }
    apart.uvs.clear();
    CHECK(make_cage(apart, false).edges.size() == 12);
    CHECK(make_cage(apart, false).places.size() == 9 + 1);
    MeshDesc folded = grid_cage(1);
    folded.position_index = {0, 1, 1, 0};
    CHECK(make_cage(folded, false).faces.empty());
    CHECK(make_cage(folded, false).dropped == 1);
    folded.position_index = {0, 1, 1, 3};
    const Cage triangle = make_cage(folded, false);
    REQUIRE(triangle.faces.size() == 1);
    CHECK(triangle.faces[0].corners == 3);
}
