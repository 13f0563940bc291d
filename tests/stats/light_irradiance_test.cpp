// Irradiance at a point by the lights' own samples, against closed forms.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "renderer/scene/scene.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr double kPiD = 3.14159265358979323846;

// The only light of a scene, as the builder makes it.
template <class Shape>
Light light_of(const Shape& shape) {
    SceneDesc scene;
    add_light(scene, shape);
    return build_scene(std::move(scene))->lights()[0];
}

Mean irradiance(const Light& light, Vec3d p, Vec3d n) {
    Random numbers(31);
    Mean mean;
    for (int i = 0; i < 200000; ++i) {
        LightSample s;
        const bool made = sample_light(light, {Vec3f(p)}, numbers.pair(), s);
        mean.add(made ? static_cast<double>(s.radiance.x) * std::max(0.0, dot(Vec3d(s.wi), n)) /
                            static_cast<double>(s.pdf)
                      : 0.0);
    }
    return mean;
}

// Within 4.5 sigma, and to a part in 1e5 where nothing is random.
void check_irradiance(const Light& light, Vec3d p, Vec3d n, double expected) {
    const Mean e = irradiance(light, p, n);
    CAPTURE(e.mean());
    CAPTURE(expected);
    CHECK(std::fabs(e.mean() - expected) < 4.5 * e.error() + 2e-5 * expected);
    CHECK(e.error() < 0.02 * std::max(expected, 1e-12));
}

// Lambert, "Photometria", 1760: E = L/2 sum of angle times the edge plane's normal on n. Polygon
// above the horizon.
double polygon_irradiance(const std::vector<Vec3d>& corners, Vec3d p, Vec3d n, double radiance) {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = normalize(corners[i] - p),
                    b = normalize(corners[(i + 1) % corners.size()] - p);
        const Vec3d c = cross(a, b);
        sum += std::atan2(length(c), dot(a, b)) * dot(normalize(c), n);
    }
    return 0.5 * radiance * std::fabs(sum);
}

}  // namespace

TEST_CASE("quad light: irradiance is Lambert's polygon formula") {
    QuadLightDesc q;
    q.corner = {-1, 2, -0.5};
    q.edges = {Double3{2, 0, 0}, Double3{0, 0, 1}};
    q.radiance = {3, 3, 3};
    // Emits along edge 0 x edge 1, which is down.
    const std::vector<Vec3d> corners{{-1, 2, -0.5}, {1, 2, -0.5}, {1, 2, 0.5}, {-1, 2, 0.5}};
    const Vec3d up{0, 1, 0}, tilted = normalize(Vec3d{0.3, 1, 0.2});
    for (const Vec3d p :
         {Vec3d{0, 0, 0}, Vec3d{0.5, 1.9, 0.1}, Vec3d{3, 0.5, 1}, Vec3d{-20, -30, 5}}) {
        check_irradiance(light_of(q), p, up, polygon_irradiance(corners, p, up, 3));
    }
    check_irradiance(light_of(q), {0, 0, 0}, tilted,
                     polygon_irradiance(corners, {0, 0, 0}, tilted, 3));
    CHECK(irradiance(light_of(q), {0, 3, 0}, {0, -1, 0}).mean() == 0);  // one-sided
    q.two_sided = true;
    check_irradiance(light_of(q), {0, 3.5, 0}, {0, -1, 0},
                     polygon_irradiance(corners, {0, 3.5, 0}, {0, -1, 0}, 3));
    q.edges = {Double3{2, 0.4, 0}, Double3{0.5, 0, 1}};  // a parallelogram
    const std::vector<Vec3d> slant{{-1, 2, -0.5}, {1, 2.4, -0.5}, {1.5, 2.4, 0.5}, {-0.5, 2, 0.5}};
    check_irradiance(light_of(q), {0.2, 0, 0}, up, polygon_irradiance(slant, {0.2, 0, 0}, up, 3));
}

TEST_CASE("disc light: irradiance of a parallel receiver, on the axis and off it") {
    DiscLightDesc d;
    d.center = {0, 2, 0};
    d.radius = 0.7;
    d.radiance = {2, 2, 2};
    for (const double a : {0.0, 0.5, 3.0}) {
        for (const double h : {0.3, 2.0, 25.0}) {
            const double r2 = 0.49, s = h * h + a * a + r2;
            const double expected =
                kPiD * 2 * 0.5 * (1 - (h * h + a * a - r2) / std::sqrt(s * s - 4 * r2 * a * a));
            check_irradiance(light_of(d), {a, 2 - h, 0}, {0, 1, 0}, expected);
        }
    }
}

TEST_CASE("sphere light: irradiance is pi L sin^2 cos while all of it is above the horizon") {
    const Light light = light_of(SphereLightDesc{{0, 3, 0}, 0.5, {4, 4, 4}});
    for (const Vec3d p :
         {Vec3d{0, 0, 0}, Vec3d{0, 2.2, 0}, Vec3d{1, 1, -0.5}, Vec3d{50, -100, 30}}) {
        const Vec3d to = Vec3d{0, 3, 0} - p;
        check_irradiance(light, p, {0, 1, 0}, kPiD * 4 * 0.25 / length2(to) * normalize(to).y);
    }
    // Inside, any receiver gets pi L.
    check_irradiance(light, {0.1, 3.1, 0.2}, normalize(Vec3d{1, 2, 3}), kPiD * 4);
}

TEST_CASE("point and spot lights: intensity over the square of the distance, within the cone") {
    check_irradiance(light_of(PointLightDesc{{1, 2, 2}, {5, 5, 5}}), {0, 0, 0}, {0, 1, 0},
                     5.0 / 9 * 2 / 3);
    SpotLightDesc s;
    s.position = {0, 2, 0};
    s.intensity = {8, 8, 8};
    s.cone_deg = 30;
    s.blend = 0;
    const double off = 2 * std::tan(25 * kPiD / 180), cosine = std::cos(25 * kPiD / 180);
    check_irradiance(light_of(s), {0, 0, 0}, {0, 1, 0}, 2);
    check_irradiance(light_of(s), {off, 0, 0}, {0, 1, 0}, 2 * std::pow(cosine, 3));
    CHECK(irradiance(light_of(s), {2 * std::tan(31 * kPiD / 180), 0, 0}, {0, 1, 0}).mean() == 0);
    s.blend = 0.5;  // full to 15 degrees, half way at the middle cosine
    check_irradiance(light_of(s), {2 * std::tan(14 * kPiD / 180), 0, 0}, {0, 1, 0},
                     2 * std::pow(std::cos(14 * kPiD / 180), 3));
    const double middle = 0.5 * (std::cos(15 * kPiD / 180) + std::cos(30 * kPiD / 180));
    check_irradiance(light_of(s), {2 * std::tan(std::acos(middle)), 0, 0}, {0, 1, 0},
                     0.5 * 2 * std::pow(middle, 3));
}

TEST_CASE("distant light: a facing surface gets the irradiance asked for at any angular size") {
    const Vec3d to = normalize(Vec3d{1, 2, 0.5});
    for (const double angle : {0.0, 0.53, 5.0, 40.0}) {
        CAPTURE(angle);
        const Light light = light_of(DistantLightDesc{{-1, -2, -0.5}, {7, 7, 7}, angle});
        check_irradiance(light, {0, 0, 0}, to, 7);
        check_irradiance(light, {0, 0, 0}, {0, 1, 0}, 7 * to.y);
    }
}

TEST_CASE("environment: irradiance is the integral of its look-ups") {
    constexpr int kW = 16, kH = 8;
    std::vector<Color> texels;
    Random n(5);
    for (int i = 0; i < kW * kH; ++i) texels.push_back(Color(n.between(0.0f, 2.0f)));
    texels[2 * kW + 5] = Color(300.0f);
    const EnvironmentLight sky = make_environment(make_latlong_map(kW, kH, texels, Color(0.5f), 70),
                                                  true, EnvironmentTable::plain);
    for (const Vec3d normal : {Vec3d{0, 1, 0}, normalize(Vec3d{1, 0.2, -1}), Vec3d{0, -1, 0}}) {
        double expected = 0;
        constexpr int kSteps = 1024;
        for (int i = 0; i < kSteps; ++i) {
            const double theta = kPiD * (i + 0.5) / kSteps;
            for (int j = 0; j < 2 * kSteps; ++j) {
                const double phi = kPiD * (j + 0.5) / kSteps;
                const Vec3d w{std::sin(theta) * std::cos(phi), std::cos(theta),
                              std::sin(theta) * std::sin(phi)};
                expected += std::max(0.0, dot(w, normal)) *
                            static_cast<double>(sky.look(Vec3f(w)).radiance.x) * std::sin(theta);
            }
        }
        expected *= kPiD * kPiD / kSteps / kSteps;
        CAPTURE(expected);
        const Mean e = irradiance(sky, {}, normal);
        CHECK(std::fabs(e.mean() - expected) < 4.5 * e.error() + 1e-4 * expected);
    }
    CHECK(std::fabs(irradiance(make_constant_environment(Color(1.5f), true), {}, {0, 1, 0}).mean() -
                    1.5 * kPiD) < 0.05);
}

TEST_CASE("environment: u = 0.5 looks along -z, v = 0 up, and the map turns about +y") {
    EnvironmentLight e =
        make_environment(8, 4, std::vector<Color>(32, Color(1.0f)), Color(1.0f), 0, true);
    CHECK(length(e.map.to_direction({0.5f, 0.5f}) - Vec3f{0, 0, -1}) < 1e-6f);
    CHECK(length(e.map.to_direction({0.75f, 0.5f}) - Vec3f{1, 0, 0}) < 1e-6f);
    CHECK(length(e.map.to_direction({0.3f, 0.0f}) - Vec3f{0, 1, 0}) < 1e-6f);
    e = make_environment(8, 4, std::vector<Color>(32, Color(1.0f)), Color(1.0f), 30, true);
    Random n(1);
    for (int i = 0; i < 1000; ++i) {
        const Vec2f uv{n.between(0.01f, 0.99f), n.between(0.01f, 0.99f)};
        const Vec2f back = e.map.to_uv(e.map.to_direction(uv));
        CHECK(std::fabs(back.x - uv.x) < 1e-4f);
        CHECK(std::fabs(back.y - uv.y) < 1e-5f);
    }
}
