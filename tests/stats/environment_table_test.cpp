// The environment's table with MIS compensation: as right as the plain one, and less noisy.
#include <doctest/doctest.h>

#include <cmath>

#include "renderer/core/sampler.h"
#include "renderer/core/warp.h"
#include "renderer/lights/light.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

using namespace tessera;

namespace {

constexpr int kW = 64, kH = 32;

// A sky brighter above and to one side, with a sun of a few texels.
EnvironmentLight sky(float sun, EnvironmentTable table) {
    std::vector<Color> texels;
    for (int y = 0; y < kH; ++y)
        for (int x = 0; x < kW; ++x) {
            const bool lit = x >= 40 && x < 43 && y >= 7 && y < 9;
            const float up = 1.0f - static_cast<float>(y) / kH;
            texels.push_back(Color(lit ? sun : 0.4f + up + 0.3f * std::sin(0.3f * float(x))));
        }
    return make_environment(make_latlong_map(kW, kH, std::move(texels), Color(1.0f), 0), true,
                            table);
}

float power(float a, float b) { return a * a / (a * a + b * b); }

// What a white matte surface gets, by one sample of the table and one of the surface.
Mean lit(const EnvironmentLight& light, Vec3f n, std::uint64_t seed, int samples) {
    const Frame frame(n);
    Random random(seed);
    Mean mean;
    for (int i = 0; i < samples; ++i) {
        double sum = 0;
        LightSample s;
        if (light.sample(random.pair(), s)) {
            const float cosine = dot(s.wi, n), pdf = cosine * kInvPi;
            if (cosine > 0.0f) sum += double(s.radiance.x * pdf / s.pdf * power(s.pdf, pdf));
        }
        const Vec3f wi = frame.to_world(warp_cosine(random.pair()));
        const auto seen = light.look(wi);
        sum += double(seen.radiance.x * power(dot(wi, n) * kInvPi, seen.pdf));
        mean.add(sum);
    }
    return mean;
}

}  // namespace

TEST_CASE("environment table: compensated and plain give the same light, the former less noise") {
    for (const float sun : {3.0f, 1e3f}) {
        const EnvironmentLight plain = sky(sun, EnvironmentTable::plain),
                               compensated = sky(sun, EnvironmentTable::compensated);
        for (const Vec3f n :
             {Vec3f{0, 1, 0}, Vec3f{1, 0, 0}, normalize(Vec3f{-0.4f, -0.6f, 0.5f})}) {
            const Mean a = lit(plain, n, 1, 200000), b = lit(compensated, n, 2, 200000);
            CAPTURE(sun);
            CAPTURE(n.y);
            CAPTURE(a.mean());
            CAPTURE(b.mean());
            // Six tests at 1e-3 in all.
            const double z = (a.mean() - b.mean()) / std::hypot(a.error(), b.error());
            CHECK(normal_p(z) > 1e-3 / 6);
            CAPTURE(a.variance());
            CAPTURE(b.variance());
            // Where the sun is all there is to find the two are as good; else it shows.
            CHECK(b.variance() < 1.05 * a.variance());
            if (sun < 10.0f && n.y == 1.0f) CHECK(b.variance() < 0.9 * a.variance());
        }
    }
}

TEST_CASE("environment table: what is left out is found by no table sample and has no density") {
    const EnvironmentLight light = sky(1e3f, EnvironmentTable::compensated);
    int without = 0;
    Random random(5);
    for (int i = 0; i < 2000; ++i) without += light.look(Vec3f(random.direction())).pdf == 0.0f;
    CHECK(without > 1000);
    // What is drawn is brighter than the mean, 1.6, but for what is blended in at a texel's edges.
    float least = 1e3f;
    for (int i = 0; i < 2000; ++i) {
        LightSample s;
        REQUIRE(light.sample(random.pair(), s));
        least = std::min(least, s.radiance.x);
    }
    CHECK(least > 0.6f);
}

TEST_CASE("environment table: a map that is the same all over keeps its plain table") {
    const EnvironmentLight light = make_environment(
        make_latlong_map(8, 4, std::vector<Color>(32, Color(2.0f)), Color(1.0f), 0), true);
    Random random(7);
    for (int i = 0; i < 200; ++i) CHECK(light.look(Vec3f(random.direction())).pdf > 0.0f);
}
