#include "renderer/lights/map_resample.h"

#include <doctest/doctest.h>

#include <limits>

#include "renderer/lights/map_source.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

using enum MapProjection;

constexpr double kPiD = 3.14159265358979323846;

struct Shape {
    MapProjection projection;
    int width, height;
};
constexpr Shape kShapes[] = {
    {latlong, 60, 30},    {cube_cross_horizontal, 64, 48}, {cube_cross_vertical, 48, 64},
    {cube_strip, 96, 16}, {mirror_ball, 48, 48},           {angular, 48, 48}};

// Smooth, and different in every direction.
Color smooth(Vec3d d) { return Color(Vec3d{1.2 + d.x, 1.2 + d.y, 1.2 + d.z}); }

template <class F>
std::vector<Color> paint(Shape s, F f) {
    std::vector<Color> picture;
    for (int y = 0; y < s.height; ++y) {
        for (int x = 0; x < s.width; ++x) {
            const auto d = map_direction(s.projection, {(x + 0.5) / s.width, (y + 0.5) / s.height});
            picture.push_back(d ? f(*d) : Color(777.0f));  // what lies off the map must not be read
        }
    }
    return picture;
}

Vec3d total_of(const std::vector<Color>& map, int height) {
    Vec3d sum;
    for (int y = 0; y < height; ++y) {
        const double each =
            kPiD / height * (std::cos(kPiD * y / height) - std::cos(kPiD * (y + 1) / height));
        for (int x = 0; x < 2 * height; ++x)
            sum += Vec3d(map[std::size_t(y) * 2 * height + x]) * each;
    }
    return sum;
}

double worst_from_smooth(const std::vector<Color>& map, int height) {
    double worst = 0;
    for (int i = 0; i < 2 * height * height; ++i) {
        const Vec3d d = *map_direction(
            latlong, {(i % (2 * height) + 0.5) / (2 * height), (i / (2 * height) + 0.5) / height});
        worst = std::max(worst, length(Vec3d(map[static_cast<std::size_t>(i)] - smooth(d))));
    }
    return worst;
}

}  // namespace

TEST_CASE("map source: texels share out the sphere as random directions find it") {
    for (const Shape s : kShapes) {
        CAPTURE(static_cast<int>(s.projection));
        const MapSource source(s.projection, s.width, s.height, paint(s, smooth));
        double sum = 0;
        for (std::size_t i = 0; i < source.texels().size(); ++i) sum += source.solid_angle(i);
        CHECK(sum == doctest::Approx(4 * kPiD));
        // Bilinear weights and solid angles both share out the sphere: over the upper half space
        // and over the right one they agree.
        Random random(5);
        Vec3d found;
        constexpr int kTries = 20000;
        for (int i = 0; i < kTries; ++i) {
            for (const auto& tap : source.taps(random.direction()))
                found += Vec3d(source.texels()[tap.texel]) * (tap.weight * 4 * kPiD / kTries);
        }
        // 4 sigma of 20000 directions: d.x varies by 1/sqrt(3).
        const double sigma = 4 * kPiD * std::sqrt(1.0 / 3 / kTries);
        CHECK(max_component(abs(found - source.total())) < 4 * sigma);
    }
}

TEST_CASE("map resample: a smooth sky comes out the same from every projection") {
    for (const Shape s : kShapes) {
        CAPTURE(static_cast<int>(s.projection));
        const auto map = resample_to_latlong(s.projection, s.width, s.height, paint(s, smooth), 32);
        REQUIRE(map.size() == 64 * 32);
        // A mirror ball crowds half the sphere into the last texels of its rim.
        CHECK(worst_from_smooth(map, 32) < (s.projection == mirror_ball ? 0.35 : 0.05));
    }
}

TEST_CASE("map resample: six faces are read as OpenGL and as an observer has them") {
    constexpr int kSize = 16;
    for (const CubeFaces faces : {CubeFaces::opengl, CubeFaces::observer}) {
        std::vector<Color> pictures[6];
        std::array<std::span<const Color>, 6> views;
        for (int face = 0; face < 6; ++face) {
            for (int i = 0; i < kSize * kSize; ++i) {
                pictures[face].push_back(smooth(face_direction(
                    faces, face, {(i % kSize + 0.5) / kSize, (i / kSize + 0.5) / kSize})));
            }
            views[static_cast<std::size_t>(face)] = pictures[face];
        }
        const auto map = resample_to_latlong(faces, kSize, views, 32);
        REQUIRE(map.size() == 64 * 32);
        CHECK(worst_from_smooth(map, 32) < 0.05);
        views[3] = views[3].first(5);
        CHECK(resample_to_latlong(faces, kSize, views, 32).empty());
    }
}

TEST_CASE("map resample: a constant stays constant") {
    for (const Shape s : kShapes) {
        const auto map = resample_to_latlong(s.projection, s.width, s.height,
                                             paint(s, [](Vec3d) { return Color(0.7f); }), 20);
        for (Color c : map) REQUIRE(max_component(abs(c - Color(0.7f))) < 1e-6f);
    }
}

TEST_CASE("map source: look-ups are continuous across edges, corners, poles and the seam") {
    Random random(6);
    for (const Shape s : kShapes) {
        if (s.projection == mirror_ball) continue;  // its rim is one direction
        CAPTURE(static_cast<int>(s.projection));
        // A texel picture with no order at all: any wrong neighbour shows.
        const MapSource source(s.projection, s.width, s.height,
                               paint(s, [&](Vec3d) { return Color(random.unit()); }));
        const auto look = [&](Vec3d d) {
            double sum = 0;
            for (const auto& tap : source.taps(d))
                sum += tap.weight * double{source.texels()[tap.texel].x};
            return sum;
        };
        for (int i = 0; i < 4000; ++i) {
            // On an edge of the cube or near its corners, on the seam or a pole of a lat-long map.
            Vec3d d = random.direction(), step = random.direction() * 1e-7;
            const double most = max_component(abs(d));
            if (s.projection == latlong) {
                d = i % 2 ? Vec3d{0, 0.9 * d.y, 1} : Vec3d{0, d.y < 0 ? -1.0 : 1.0, 0};
                step.y = 0;
            } else if (s.projection == angular) {
                d = {0, d.y * 0.2, -1};
            } else {
                (i % 2 ? d.x : d.z) = most;
                d.y = i % 3 ? most : d.y;
            }
            // A texel is 0.05 and more across: slopes stay below 50.
            REQUIRE(std::abs(look(normalize(d + step)) - look(normalize(d - step))) <= 1e-5);
        }
    }
}

TEST_CASE("map resample: a hot texel brings its light, neither more nor less") {
    Random random(7);
    for (const Shape s : kShapes) {
        CAPTURE(static_cast<int>(s.projection));
        auto picture = paint(s, [](Vec3d) { return Color(1.0f); });
        for (int trial = 0; trial < 6; ++trial) {
            std::size_t hot = 0;
            do {
                hot = random.bits() % picture.size();
            } while (picture[hot].x > 1.0f);
            picture[hot] = {1e5f, 1.0f, 0.5e5f};
            const MapSource source(s.projection, s.width, s.height, picture);
            // Coarser, as fine, finer.
            for (const int height : {7, 24, 60}) {
                CAPTURE(height);
                const auto map =
                    resample_to_latlong(s.projection, s.width, s.height, picture, height);
                const Vec3d total = total_of(map, height), wanted = source.total();
                CHECK(std::abs(total.x / wanted.x - 1) < 1e-5);
                CHECK(std::abs(total.z / wanted.z - 1) < 1e-5);
                // The sky that the sun leaves alone keeps its level.
                CHECK(std::abs(total.y / (4 * kPiD) - 1) < 1e-5);
                int dimmed = 0;
                for (Color c : map) dimmed += std::abs(c.x - 1.0f) > 5e-3f;
                if (height == 60) CHECK(dimmed < 0.08 * static_cast<double>(map.size()));
            }
            picture[hot] = Color(1.0f);
        }
    }
}

TEST_CASE("map resample: a hot texel stays in its direction") {
    Random random(8);
    for (const Shape s : kShapes) {
        CAPTURE(static_cast<int>(s.projection));
        auto picture = paint(s, [](Vec3d) { return Color(0.0f); });
        Vec3d where;
        for (;;) {
            const std::size_t hot = random.bits() % picture.size();
            const int x = static_cast<int>(hot) % s.width, y = static_cast<int>(hot) / s.width;
            const auto d = map_direction(s.projection, {(x + 0.5) / s.width, (y + 0.5) / s.height});
            if (!d || std::abs(d->z) > 0.8) continue;
            picture[hot] = Color(1e5f);
            where = *d;
            break;
        }
        for (Color& c : picture) c = c.x == 777.0f ? Color(0.0f) : c;
        const auto map = resample_to_latlong(s.projection, s.width, s.height, picture, 30);
        Vec3d mean;
        for (int i = 0; i < 60 * 30; ++i) {
            const MapPoint p{(i % 60 + 0.5) / 60, (i / 60 + 0.5) / 30};
            mean += *map_direction(latlong, p) *
                    (double{map[static_cast<std::size_t>(i)].x} * std::sin(kPiD * p.y));
        }
        CHECK(dot(normalize(mean), where) > 0.995);  // 6 degrees, a texel
    }
}

TEST_CASE("map resample: broken texels count as black and impossible pictures give nothing") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (const Shape s : kShapes) {
        auto picture = paint(s, [](Vec3d) { return Color(1.0f); });
        const std::size_t middle = std::size_t(s.height / 2) * s.width + s.width / 2;
        picture[middle] = {kNan, 1.0f, kInfinity};
        picture[middle - 1] = Color(3e38f);
        picture[middle - 2] = Color(-1e30f);
        const auto map = resample_to_latlong(s.projection, s.width, s.height, picture, 9);
        REQUIRE(map.size() == 18 * 9);
        for (Color c : map) REQUIRE(is_finite(c));
        CHECK(resample_to_latlong(s.projection, s.width, s.height, picture, 0).empty());
        CHECK(resample_to_latlong(s.projection, s.width, -1, picture, 8).empty());
        CHECK(resample_to_latlong(s.projection, s.width, s.height,
                                  std::span<const Color>(picture).first(10), 8)
                  .empty());
    }
    const std::vector<Color> one(1, Color(2.0f));
    for (const MapProjection p : {latlong, mirror_ball, angular})
        CHECK(resample_to_latlong(p, 1, 1, one, 1) == std::vector<Color>(2, Color(2.0f)));
}
