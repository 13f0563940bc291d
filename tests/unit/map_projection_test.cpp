#include "renderer/lights/map_projection.h"

#include <doctest/doctest.h>

#include <limits>

#include "renderer/lights/light.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

using enum MapProjection;

constexpr MapProjection kAll[] = {latlong,    cube_cross_horizontal, cube_cross_vertical,
                                  cube_strip, mirror_ball,           angular};

double apart(Vec3d a, Vec3d b) { return length(a - b); }

void shows(MapProjection projection, double u, double v, Vec3d d) {
    CAPTURE(static_cast<int>(projection));
    CAPTURE(u);
    CAPTURE(v);
    const auto seen = map_direction(projection, {u, v});
    REQUIRE(seen);
    CHECK(apart(*seen, normalize(d)) < 1e-7);  // the rim of a ball: half of all digits
    const MapPoint p = map_point(projection, normalize(d));
    CHECK(std::hypot(p.x - u, p.y - v) < 1e-12);
}

}  // namespace

TEST_CASE("map projection: every direction comes back from every projection") {
    Random random(1);
    for (const MapProjection projection : kAll) {
        CAPTURE(static_cast<int>(projection));
        for (int i = 0; i < 20000; ++i) {
            const Vec3d d = random.direction();
            const MapPoint p = map_point(projection, d);
            const auto back = map_direction(projection, p);
            REQUIRE(back);
            REQUIRE(apart(*back, d) < 1e-5);
            REQUIRE(std::abs(length(*back) - 1) < 1e-12);
        }
    }
}

TEST_CASE("map projection: every point that shows something comes back") {
    Random random(2);
    for (const MapProjection projection : kAll) {
        CAPTURE(static_cast<int>(projection));
        int shown = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec2f u = random.pair();
            const auto d = map_direction(projection, {double{u.x}, double{u.y}});
            if (!d) continue;
            ++shown;
            const MapPoint p = map_point(projection, *d);
            REQUIRE(std::hypot(p.x - double{u.x}, p.y - double{u.y}) < 1e-7);
        }
        // A cross fills half, a disc pi / 4; 4 sigma of the count.
        const double part = projection == latlong || projection == cube_strip ? 1
                            : cube_layout(projection)                         ? 0.5
                                                                              : 0.785398;
        CHECK(std::abs(shown / 20000.0 - part) <= 4 * std::sqrt(part * (1 - part) / 20000));
    }
}

TEST_CASE("map projection: landmarks of each picture are where its definition says") {
    shows(latlong, 0.5, 0.5, {0, 0, -1});
    shows(latlong, 0.75, 0.5, {1, 0, 0});
    shows(latlong, 0.25, 0.5, {-1, 0, 0});
    shows(latlong, 0.5, 0.25, {0, 1, -1});
    shows(cube_cross_horizontal, 1.5 / 4, 0.5, {0, 0, -1});
    shows(cube_cross_horizontal, 2.5 / 4, 0.5, {1, 0, 0});
    shows(cube_cross_horizontal, 3.5 / 4, 0.5, {0, 0, 1});
    shows(cube_cross_horizontal, 0.5 / 4, 0.5, {-1, 0, 0});
    shows(cube_cross_horizontal, 1.75 / 4, 1.25 / 3, {0.5, 0.5, -1});
    shows(cube_cross_horizontal, 1.5 / 4, 0.75 / 3, {0, 1, -0.5});
    shows(cube_cross_horizontal, 1.5 / 4, 2.25 / 3, {0, -1, -0.5});
    shows(cube_cross_vertical, 0.5, 1.5 / 4, {0, 0, -1});
    shows(cube_cross_vertical, 2.75 / 3, 1.5 / 4, {1, 0, 0.5});
    shows(cube_cross_vertical, 0.5, 3.25 / 4, {0, -0.5, 1});  // upside down
    shows(cube_cross_vertical, 1.75 / 3, 3.5 / 4, {0.5, 0, 1});
    shows(mirror_ball, 0.5, 0.5, {0, 0, 1});
    shows(mirror_ball, 0.5 + 0.5 * std::sqrt(0.5), 0.5, {1, 0, 0});
    shows(mirror_ball, 0.5, 0.5 - 0.5 * std::sqrt(0.5), {0, 1, 0});
    shows(mirror_ball, 1, 0.5, {0, 0, -1});
    shows(angular, 0.5, 0.5, {0, 0, -1});
    shows(angular, 0.75, 0.5, {1, 0, 0});
    shows(angular, 0.5, 0.25, {0, 1, 0});
    shows(angular, 1, 0.5, {0, 0, 1});
}

TEST_CASE("map projection: a strip's faces lie as the table of OpenGL says") {
    // (s, t) from the table for a direction beside the middle of each face.
    for (int face = 0; face < 6; ++face) {
        CAPTURE(face);
        const double sign = face % 2 ? -1 : 1;
        const Vec3d d = face < 2   ? Vec3d{sign, 0.2, 0.6}
                        : face < 4 ? Vec3d{0.2, sign, 0.6}
                                   : Vec3d{0.2, 0.6, sign};
        const double sc = face < 2 ? -sign * d.z : (face < 4 ? d.x : sign * d.x);
        const double tc = face < 2 ? -d.y : (face < 4 ? sign * d.z : -d.y);
        shows(cube_strip, (face + 0.5 * (sc + 1)) / 6, 0.5 * (tc + 1), d);
        const FacePoint p = face_point(CubeFaces::opengl, d);
        CHECK(p.face == face);
        CHECK(apart(face_direction(CubeFaces::opengl, face, p.p), normalize(d)) < 1e-12);
    }
}

TEST_CASE("map projection: an observer's faces are no mirror images, OpenGL's are") {
    for (int face = 0; face < 6; ++face) {
        const FaceFrame o = face_frame(CubeFaces::observer, face);
        const FaceFrame g = face_frame(CubeFaces::opengl, face);
        CHECK(dot(cross(o.right, -o.down), -o.forward) == 1);
        CHECK(dot(cross(g.right, -g.down), -g.forward) == -1);
    }
}

TEST_CASE("map projection: cells that touch in a cross show the same directions along the edge") {
    constexpr double kStep = 1e-9;
    const auto seam = [](MapProjection projection, double u, double v, double du, double dv) {
        const auto a = map_direction(projection, {u - kStep * du, v - kStep * dv}),
                   b = map_direction(projection, {u + kStep * du, v + kStep * dv});
        REQUIRE(a);
        REQUIRE(b);
        CHECK(apart(*a, *b) < 1e-7);
    };
    for (const double t : {0.1, 0.5, 0.8}) {
        for (const double edge : {0.25, 0.5, 0.75})
            seam(cube_cross_horizontal, edge, (1 + t) / 3, 1, 0);
        for (const double edge : {1.0, 2.0}) {
            seam(cube_cross_horizontal, (1 + t) / 4, edge / 3, 0, 1);
            seam(cube_cross_vertical, edge / 3, (1 + t) / 4, 1, 0);
        }
        for (const double edge : {0.25, 0.5, 0.75})
            seam(cube_cross_vertical, (1 + t) / 3, edge, 0, 1);
    }
}

TEST_CASE("map projection: poles, rims and seams have a point inside the picture") {
    for (const MapProjection projection : kAll) {
        CAPTURE(static_cast<int>(projection));
        for (const double sign : {-1.0, 1.0}) {
            for (const Vec3d d :
                 {Vec3d{sign, 0, 0}, Vec3d{0, sign, 0}, Vec3d{0, 0, sign}, Vec3d{0, -0.0, sign},
                  Vec3d{-0.0, 0, sign}, normalize(Vec3d{sign, sign, sign}),
                  normalize(Vec3d{sign, 0, 1}), Vec3d{1e-300, 0, sign}}) {
                const MapPoint p = map_point(projection, d);
                const auto back = map_direction(projection, p);
                REQUIRE(back);
                CHECK(apart(*back, d) < 1e-7);
            }
        }
    }
}

TEST_CASE("map projection: nothing is shown outside") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    constexpr double kHuge = std::numeric_limits<double>::infinity();
    for (const MapProjection projection : kAll) {
        for (const MapPoint p :
             {MapPoint{-0.01, 0.5}, {0.5, 1.01}, {kNan, 0.5}, {0.5, kHuge}, {-1e30, 1e30}})
            CHECK_FALSE(map_direction(projection, p));
    }
    CHECK_FALSE(map_direction(cube_cross_horizontal, {0.1, 0.1}));
    CHECK_FALSE(map_direction(cube_cross_vertical, {0.9, 0.9}));
    CHECK_FALSE(map_direction(mirror_ball, {0.01, 0.01}));
    CHECK_FALSE(map_direction(angular, {0.99, 0.01}));
}

TEST_CASE("map projection: a camera's rays in float are those of the map") {
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
        const Vec2f u = random.pair();
        const MapPoint p{double{u.x}, double{u.y}};
        // Float: 24 bits of u turned into up to 2 pi.
        REQUIRE(apart(Vec3d(latlong_direction(u)), *map_direction(latlong, p)) < 2e-6);
    }
}

TEST_CASE("map projection: the environment light reads a lat-long map in the same frame") {
    const EnvironmentLight light =
        make_environment(2, 1, std::vector<Color>(2, Color(1.0f)), Color(1.0f), 0, true);
    Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3d d = random.direction();
        const MapPoint p = map_point(latlong, d);
        const Vec2f uv = light.map.to_uv(Vec3f(d));
        REQUIRE(std::abs(p.x - double{uv.x}) < 1e-5);
        REQUIRE(std::abs(p.y - double{uv.y}) < 1e-6);
    }
}

TEST_CASE("map projection: a size suggests its projection, a square two") {
    const auto only = [](int width, int height, MapProjection projection) {
        const auto guess = guess_projection(width, height);
        return guess.size() == 1 && guess[0] == projection;
    };
    CHECK(only(2048, 1024, latlong));
    CHECK(only(1024, 768, cube_cross_horizontal));
    CHECK(only(768, 1024, cube_cross_vertical));
    CHECK(only(1536, 256, cube_strip));
    const auto square = guess_projection(512, 512);
    REQUIRE(square.size() == 2);
    CHECK(square[0] == mirror_ball);
    CHECK(square[1] == angular);
    for (const auto& [width, height] :
         {std::pair{0, 0}, {-2, -1}, {1920, 1080}, {1025, 768}, {2147483647, 1}, {1, 2147483647}})
        CHECK(guess_projection(width, height).empty());
    CHECK_FALSE(projection_fits(cube_cross_horizontal, 4, 4));
    CHECK_FALSE(projection_fits(angular, 5, 4));
    CHECK_FALSE(projection_fits(latlong, 0, 4));
}
