#include "renderer/io/triangulate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace tessera {
namespace {

using Polygon = std::vector<Vec3d>;

double area_of(const Polygon& p, const std::vector<Triangulator::Triangle>& triangles) {
    double sum = 0;
    for (const auto& t : triangles)
        sum += 0.5 * length(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    return sum;
}

// Every triangle turns the way the outline does, and together they cover its area: no overlap.
void check_cover(const Polygon& p, double area) {
    Triangulator triangulator;
    const auto& triangles = triangulator.run(p);
    CHECK_FALSE(triangulator.fell_back());
    CHECK(area_of(p, triangles) == doctest::Approx(area).epsilon(1e-9));
    const Vec3d normal = newell(p);
    for (const auto& t : triangles)
        CHECK(dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), normal) >= 0);
}

Polygon tilted(const Polygon& flat) {
    Polygon out;
    for (const Vec3d& p : flat) out.emplace_back(p.x + 0.5 * p.y, p.y - p.x, 2 * p.x + p.y + 7);
    return out;
}

}  // namespace

TEST_CASE("triangulate: a concave outline is covered once, in any plane") {
    const Polygon comb{{0, 0, 0}, {7, 0, 0}, {7, 3, 0}, {6, 1, 0}, {5, 3, 0},
                       {4, 1, 0}, {3, 3, 0}, {2, 1, 0}, {1, 3, 0}};
    check_cover(comb, 0.5 * length(newell(comb)));
    const Polygon slanted = tilted(comb);
    check_cover(slanted, 0.5 * length(newell(slanted)));
}

TEST_CASE("triangulate: a keyhole leaves its hole open") {
    const Polygon keyhole{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                          {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
    check_cover(keyhole, 16 - 4);
    Triangulator triangulator;
    for (const auto& t : triangulator.run(keyhole)) {
        const Vec3d middle = (keyhole[t[0]] + keyhole[t[1]] + keyhole[t[2]]) / 3.0;
        CHECK_FALSE((middle.x > 1 && middle.x < 3 && middle.y > 1 && middle.y < 3));
    }
}

TEST_CASE("triangulate: collinear and repeated corners and spikes do no harm") {
    const Polygon square{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0},
                         {2, 3, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    check_cover(square, 4);
}

TEST_CASE("triangulate: a polygon without area gives nothing") {
    Triangulator triangulator;
    CHECK(triangulator.run(Polygon{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}).empty());
    CHECK(triangulator.run(Polygon{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).empty());
    CHECK(triangulator.run(Polygon{{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST_CASE("triangulate: random stars of up to 5000 corners are covered once") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> radius(0.2, 1.0);
    for (const int n : {5, 17, 300, 5000}) {
        Polygon star;
        for (int i = 0; i < n; ++i) {
            const double angle = 6.283185307179586 * i / n;
            const double r = radius(random);
            star.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
        }
        check_cover(star, 0.5 * length(newell(star)));
    }
}

TEST_CASE("triangulate: an outline that crosses itself ends within its budget") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> place(-1, 1);
    Polygon tangle;
    for (int i = 0; i < 20000; ++i)
        tangle.emplace_back(place(random), place(random), place(random));
    Triangulator triangulator;
    const auto& triangles = triangulator.run(tangle);
    CHECK(triangles.size() <= tangle.size() - 2);
    for (const auto& t : triangles)
        for (const std::uint32_t corner : t) CHECK(corner < tangle.size());
}

TEST_CASE("triangulate: a flat convex quad keeps its order") {
    const std::array<Vec3d, 4> square{Vec3d{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const QuadShape shape = shape_quad(square);
    CHECK(shape.is_quad);
    CHECK(shape.quad == std::array<std::uint8_t, 4>{0, 1, 2, 3});
}

TEST_CASE("triangulate: a concave quad is turned so that the split is inside") {
    // The notch is corner 0: only the diagonal 0-2 lies inside.
    const std::array<Vec3d, 4> notch{Vec3d{0.2, 0.2, 0}, {0, -1, 0}, {1, 1, 0}, {-1, 0, 0}};
    const QuadShape shape = shape_quad(notch);
    CHECK(shape.is_quad);
    CHECK(shape.quad == std::array<std::uint8_t, 4>{1, 2, 3, 0});
}

TEST_CASE("triangulate: a bent quad becomes two triangles along its shorter diagonal") {
    const std::array<Vec3d, 4> bent{Vec3d{0, 0, 0}, {2, 0, 1}, {1, 1, 0}, {0, 2, 1}};
    const QuadShape shape = shape_quad(bent);
    CHECK_FALSE(shape.is_quad);
    CHECK(shape.triangles == 2);
    CHECK(shape.triangle[0] == std::array<std::uint8_t, 3>{0, 1, 2});
}

TEST_CASE("triangulate: a bent concave quad takes the diagonal inside it, though longer") {
    const std::array<Vec3d, 4> arrow{Vec3d{0, 0, 0}, {10, -0.5, 1}, {8, 0, 0}, {10, 0.5, 1}};
    const QuadShape shape = shape_quad(arrow);
    CHECK_FALSE(shape.is_quad);
    CHECK(shape.triangle[0] == std::array<std::uint8_t, 3>{0, 1, 2});
    CHECK(shape.triangle[1] == std::array<std::uint8_t, 3>{2, 3, 0});
}

TEST_CASE("triangulate: a quad with all corners on a line is nothing") {
    const std::array<Vec3d, 4> line{Vec3d{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    const QuadShape shape = shape_quad(line);
    CHECK_FALSE(shape.is_quad);
    CHECK(shape.triangles == 0);
}

}  // namespace tessera
