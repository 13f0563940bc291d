#include "renderer/lights/sky_model.h"

#include <doctest/doctest.h>

#include <limits>
#include <tuple>

#include "renderer/lights/map_projection.h"
#include "renderer/lights/visible_spectrum.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

constexpr double kPiD = 3.14159265358979323846;

double luminance(Color c) { return dot(Vec3d(c), {0.2126, 0.7152, 0.0722}); }

SkySettings at(double elevation_deg, double turbidity, float albedo = 0.2f) {
    SkySettings s;
    s.turbidity = turbidity;
    s.ground_albedo = Color(albedo);
    s.sun = sky_direction(0, elevation_deg * kPiD / 180);
    return s;
}

Vec3f toward(double azimuth_deg, double elevation_deg) {
    return Vec3f(sky_direction(azimuth_deg * kPiD / 180, elevation_deg * kPiD / 180));
}

// The same air, flat, by photons that scatter until they are gone: share of the sun's light on
// level ground above the air that reaches the ground scattered, by wavelength.
struct FlatAir {
    double gas, haze, ozone, albedo;  // vertical optical thickness; of the ground

    static double ozone_above(double h) {
        const double t = std::clamp((h - 25) / 15, -1.0, 1.0);
        return t < 0 ? 1 - 0.5 * (1 + t) * (1 + t) : 0.5 * (1 - t) * (1 - t);
    }
    double above(double h) const {
        return gas * std::exp(-h / 8) + haze * std::exp(-h / 1.2) + ozone * ozone_above(h);
    }
    double height(double thickness_above) const {
        double low = 0, high = 100;
        for (int i = 0; i < 30; ++i) {
            const double middle = 0.5 * (low + high);
            (above(middle) > thickness_above ? low : high) = middle;
        }
        return low;
    }
    double scattered_on_ground(double sun_elevation, int photons, Random& random) const {
        const auto unit = [&] { return double{random.unit()}; };
        double sum = 0;
        for (int i = 0; i < photons; ++i) {
            Vec3d d = -sky_direction(0, sun_elevation);
            double at = 0, weight = 1;  // at: thickness above
            for (bool scattered = false; weight > 1e-3; scattered = true) {
                at += d.y * std::log(1 - unit());
                if (at < 0) break;
                if (at >= above(0)) {
                    sum += scattered ? weight : 0;
                    weight *= albedo;
                    at = above(0);
                    const double c = std::sqrt(1 - unit()), a = 2 * kPiD * unit();
                    d = {std::sqrt(1 - c * c) * std::cos(a), c, std::sqrt(1 - c * c) * std::sin(a)};
                    continue;
                }
                const double h = height(at), g = gas / 8 * std::exp(-h / 8),
                             z = haze / 1.2 * std::exp(-h / 1.2),
                             o = ozone / 15 * std::max(0.0, 1 - std::abs(h - 25) / 15);
                const double pick = unit() * (g + z + o);
                if (pick > g + z) break;
                const bool by_haze = pick > g;
                weight *= by_haze ? 0.92 : 1;
                double c;
                do {  // both phase functions are (1 + c^2) times one that is easy
                    const double t = 0.36 / (1 - 0.8 + 1.6 * unit());
                    c = by_haze ? (1.64 - t * t) / 1.6 : 2 * unit() - 1;
                } while (2 * unit() > 1 + c * c);
                const Vec3d s =
                    normalize(cross(d, std::abs(d.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0}));
                const double a = 2 * kPiD * unit(), r = std::sqrt(std::max(0.0, 1 - c * c));
                d = normalize(d * c + (s * std::cos(a) + cross(d, s) * std::sin(a)) * r);
            }
        }
        return sum / photons;
    }
};

double blue_to_red(Color c) { return double{c.z} / double{c.x}; }

}  // namespace

TEST_CASE("visible spectrum: light of equal power at all wavelengths has its watts as luminance") {
    const Color c = to_rgb(Spectrum(static_cast<float>(1 / (kLongest_nm - kShortest_nm))));
    CHECK(luminance(c) == doctest::Approx(1).epsilon(1e-4));
    // CIE illuminant E in Rec.709: IEC 61966-2-1 from XYZ (1, 1, 1). The fits are good to a
    // percent.
    CHECK(std::abs(c.x - 1.205f) < 0.02f);
    CHECK(std::abs(c.y - 0.948f) < 0.02f);
    CHECK(std::abs(c.z - 0.909f) < 0.02f);
}

TEST_CASE("visible spectrum: sunlight has the visible part of the solar constant") {
    const Spectrum sun = sunlight();
    double sum = 0;
    for (int i = 0; i < kWavelengths; ++i) sum += double{sun[i]} * kBand_nm;
    double part = 0, all = 0;
    for (double nm = 50; nm < 60000; nm += 5) {
        const double b = std::pow(nm, -5) / std::expm1(1.438776877e7 / (nm * 5778));
        all += b;
        if (nm >= kShortest_nm && nm < kLongest_nm) part += b;
    }
    CHECK(sum == doctest::Approx(1361 * part / all).epsilon(0.005));  // bands of 21 nm
    CHECK(sum > 530);
    CHECK(sum < 600);
}

TEST_CASE("visible spectrum: pure colours keep their luminance and have no negative channel") {
    for (int i = 0; i < kWavelengths; ++i) {
        Spectrum line(0.0f);
        line.v[i] = 1.0f;
        const Color c = to_rgb(line);
        CHECK(min_component(c) >= 0.0f);
        CHECK(luminance(c) > 0);
    }
    Spectrum broken(std::numeric_limits<float>::quiet_NaN());
    CHECK(to_rgb(broken) == Color(0.0f));
}

TEST_CASE("visible spectrum: the exponential of all wavelengths is that of the library") {
    for (const float x : {0.0f, 1e-6f, 0.3f, 1.0f, 17.3f, 80.0f, 100.0f, 1e30f, kInfinity}) {
        const double e = std::exp(-double{x});
        CHECK(std::abs(double{exp_minus(Spectrum(x))[3]} - e) <= 2e-6 * e + 1e-37);
    }
}

TEST_CASE("sky model: a high sun has a blue zenith and a pale horizon") {
    for (const double turbidity : {2.0, 4.0}) {
        const SkyModel sky(at(50, turbidity));
        const Color zenith = sky.radiance({0, 1, 0}), level = sky.radiance(toward(90, 2));
        CHECK(zenith.z > zenith.y);
        CHECK(zenith.y > zenith.x);
        CHECK(blue_to_red(zenith) > 1.15 * blue_to_red(level));
        CHECK(luminance(level) > luminance(sky.radiance(toward(180, 60))));
    }
}

TEST_CASE("sky model: the sun grows dimmer and redder as it sets, and stays out") {
    double last = 1e9, last_ratio = 1e9;
    for (const double elevation : {90.0, 40.0, 15.0, 5.0, 1.5, 0.0}) {
        const SkyModel sky(at(elevation, 2.5));
        const double now = luminance(sky.sun_irradiance());
        const double ratio = blue_to_red(sky.sun_irradiance());
        CHECK(now < last);
        CHECK(ratio <= last_ratio);
        last = now, last_ratio = ratio;
        const double disc = kPiD * std::pow(std::sin(0.2665 * kPiD / 180), 2);
        CHECK(luminance(sky.sun_radiance()) * disc == doctest::Approx(now).epsilon(1e-3));
    }
    CHECK(last_ratio < 0.02);
    CHECK(max_component(SkyModel(at(-2, 2.5)).sun_radiance()) == 0.0f);
}

TEST_CASE("sky model: a clear noon sends what is measured") {
    const SkyModel sky(at(60, 2.5));
    const double level = std::sin(60 * kPiD / 180);
    const double beam = luminance(sky.sun_irradiance()), diffuse = luminance(sky.sky_irradiance());
    // Direct normal 800 to 1000 W/m^2 of all wavelengths on a clear day (Iqbal, "An Introduction to
    // Solar Radiation", 1983), 0.44 to 0.50 of it visible.
    CHECK(beam > 0.44 * 800);
    CHECK(beam < 0.50 * 1000);
    // 850 to 1000 W/m^2 on level ground at 100 to 115 lm/W (Littlefair, "The luminous efficacy of
    // daylight: a review", Lighting Research & Technology 17(4), 1985); ours are 215 lm/W.
    const double klx = 0.215 * (beam * level + diffuse);
    CHECK(klx > 85);
    CHECK(klx < 115);
    // A clear sky's share of it, 10 to 25 percent.
    CHECK(diffuse / (beam * level + diffuse) > 0.10);
    CHECK(diffuse / (beam * level + diffuse) < 0.25);
}

TEST_CASE("sky model: the sky's irradiance is the integral of its radiance") {
    for (const double elevation : {5.0, 50.0}) {
        const SkyModel sky(at(elevation, 4));
        Vec3d sum;
        constexpr int kWidth = 256, kHeight = 128;
        const auto map = sky.latlong(kWidth, kHeight);
        for (int i = 0; i < kWidth * kHeight / 2; ++i) {
            const double theta = kPiD * (i / kWidth + 0.5) / kHeight;
            sum += Vec3d(map[static_cast<std::size_t>(i)]) *
                   (std::sin(theta) * std::cos(theta) * 2 * kPiD * kPiD / kWidth / kHeight);
        }
        // The model's own sum runs over a few hundred nodes.
        CHECK(luminance(sky.sky_irradiance()) ==
              doctest::Approx(luminance(Color(sum))).epsilon(0.02));
    }
}

TEST_CASE("sky model: the ground gets the light that photons bring through the same air") {
    Random random(12);
    for (const auto& [turbidity, elevation, albedo] :
         {std::tuple{2.0, 35.0, 0.1}, {10.0, 70.0, 0.9}}) {
        Spectrum on_ground(0.0f);
        for (int i = 0; i < kWavelengths; ++i) {
            const double um = wavelength_nm(i) * 1e-3, q = 1 / (um * um);
            const FlatAir air{
                0.008569 * q * q * (1 + 0.0113 * q + 0.00013 * q * q),
                (0.04608 * turbidity - 0.04586) * std::pow(um, -1.3),
                300 * 2.687e16 * 5e-21 * std::exp(-0.5 * std::pow((um - 0.595) / 0.052, 2)),
                albedo};
            const double sine = std::sin(elevation * kPiD / 180);
            on_ground.v[i] = static_cast<float>(
                sine * air.scattered_on_ground(elevation * kPiD / 180, 1500, random));
        }
        const double photons = luminance(to_rgb(on_ground * sunlight()));
        const SkyModel sky(at(elevation, turbidity, static_cast<float>(albedo)));
        CAPTURE(photons);
        CAPTURE(luminance(sky.sky_irradiance()));
        // 1.5 percent of noise; 3 to 7 percent are what taking repeated scattering for even costs.
        CHECK(luminance(sky.sky_irradiance()) == doctest::Approx(photons).epsilon(0.11));
    }
}

TEST_CASE("sky model: bright ground brightens the sky, coloured ground colours it") {
    const SkyModel dark(at(45, 3, 0)), bright(at(45, 3, 0.8f));
    CHECK(luminance(bright.sky_irradiance()) > 1.1 * luminance(dark.sky_irradiance()));
    CHECK(luminance(bright.sky_irradiance()) < 1.8 * luminance(dark.sky_irradiance()));
    CHECK(bright.sun_irradiance() == dark.sun_irradiance());
    SkySettings red = at(45, 3);
    red.ground_albedo = {0.8f, 0.0f, 0.0f};
    const SkyModel desert(red);
    CHECK(blue_to_red(desert.radiance({0, 1, 0})) < 0.95 * blue_to_red(dark.radiance({0, 1, 0})));
    // Seen from straight above the ground is a Lambertian's share of what falls on it, through 200
    // m of air that takes a few percent and adds some.
    const double ground = luminance(bright.radiance({0, -1, 0}));
    const double falls = luminance(bright.sky_irradiance()) +
                         luminance(bright.sun_irradiance()) * std::sin(0.25 * kPiD);
    CHECK(ground == doctest::Approx(0.8 / kPiD * falls).epsilon(0.06));
}

TEST_CASE("sky model: haze gathers light around the sun and takes it from the sun") {
    double last_glow = 0, last_sun = 1e9;
    for (const double turbidity : {1.8, 3.0, 6.0}) {
        const SkyModel sky(at(50, turbidity));
        const double glow = luminance(sky.radiance(toward(0, 46))),
                     sun = luminance(sky.sun_irradiance());
        CHECK(glow > 1.2 * last_glow);
        CHECK(sun < last_sun);
        last_glow = glow, last_sun = sun;
    }
}

TEST_CASE("sky model: radiance is finite, positive and continuous everywhere") {
    Random random(11);
    for (const double turbidity : {1.8, 10.0}) {
        for (const double elevation : {-5.0, -0.5, 3.0, 30.0, 90.0}) {
            CAPTURE(turbidity);
            CAPTURE(elevation);
            const SkyModel sky(at(elevation, turbidity));
            const double mean = luminance(sky.sky_irradiance()) / kPiD;
            REQUIRE(mean > 0);
            double worst = 0;
            for (int i = 0; i < 3000; ++i) {
                // Two thirds near the horizon.
                Vec3d d = random.direction();
                if (i % 3) d.y *= 0.02;
                d = normalize(d);
                const Color a = sky.radiance(Vec3f(d));
                REQUIRE(is_finite(a));
                REQUIRE(min_component(a) >= 0.0f);
                const Color b = sky.radiance(Vec3f(normalize(d + random.direction() * 1e-4)));
                worst = std::max(
                    worst, std::abs(luminance(a) - luminance(b)) / (luminance(a) + 0.1 * mean));
            }
            // 0.006 degrees. Clear air shows the far ground's edge, spread over 0.2 degrees.
            CHECK(worst < 0.1);
            for (const Vec3f pole : {Vec3f{0, 1, 0}, Vec3f{0, -1, 0}})
                CHECK(is_finite(sky.radiance(pole)));
        }
    }
}

TEST_CASE("sky model: the sky has no step at the horizon") {
    for (const double elevation : {2.0, 40.0}) {
        const SkyModel sky(at(elevation, 2));
        for (double azimuth = 0; azimuth < 360; azimuth += 17) {
            for (double e = -1.5; e < 1; e += 0.01) {
                const double a = luminance(sky.radiance(toward(azimuth, e))),
                             b = luminance(sky.radiance(toward(azimuth, e + 0.01)));
                REQUIRE(std::abs(a - b) < 0.08 * (a + b));
            }
        }
    }
}

TEST_CASE("sky model: a set sun leaves a dark sky that darkens on, bluer above than its glow") {
    double last = luminance(SkyModel(at(0, 3)).sky_irradiance());
    for (const double elevation : {-3.0, -6.0, -15.0, -90.0}) {
        const SkyModel sky(at(elevation, 3));
        const double now = luminance(sky.sky_irradiance());
        CHECK(now >= 0);
        CHECK(now < 0.5 * last + 1e-9);
        if (elevation > -7) {
            CHECK(luminance(sky.radiance(toward(0, 3))) > luminance(sky.radiance(toward(180, 3))));
            CHECK(blue_to_red(sky.radiance({0, 1, 0})) > blue_to_red(sky.radiance(toward(0, 1))));
        }
        last = now;
    }
    CHECK(last < 1e-4);
}

TEST_CASE("sky model: it turns with the sun") {
    SkySettings s = at(20, 3);
    const SkyModel north(s);
    s.sun = sky_direction(2.1, 20 * kPiD / 180);
    const SkyModel turned(s);
    const double off = 2.1 * 180 / kPiD;
    for (const double azimuth : {0.0, 30.0, 170.0}) {
        const Color a = north.radiance(toward(azimuth, 25)),
                    b = turned.radiance(toward(azimuth + off, 25));
        CHECK(max_component(abs(a - b)) < 1e-3f * max_component(a));
    }
    CHECK(length(sky_direction(0, 0) - Vec3d{0, 0, -1}) < 1e-12);
    CHECK(length(sky_direction(0.5 * kPiD, 0) - Vec3d{1, 0, 0}) < 1e-12);
    // The map holds what radiance() says where the environment light looks for it.
    const auto map = turned.latlong(64, 32);
    const auto d = map_direction(MapProjection::latlong, {(40 + 0.5) / 64, (9 + 0.5) / 32});
    CHECK(max_component(abs(map[9 * 64 + 40] - turned.radiance(Vec3f(*d)))) <
          1e-4f * max_component(map[9 * 64 + 40]));
}

TEST_CASE("sky model: senseless settings are clamped") {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                     kInf = std::numeric_limits<double>::infinity();
    constexpr auto kNanF = std::numeric_limits<float>::quiet_NaN();
    const SkySettings all[] = {{kNan, Color(kNanF), {kNan, 0, 0}, kNan},
                               {-1e30, Color(-1e30f), {0, 0, 0}, -1},
                               {1e30, Color(kInfinity), {kInf, 1, 1}, 1e30}};
    for (const SkySettings& s : all) {
        const SkyModel sky(s);
        CHECK(is_finite(sky.sun_radiance()));
        for (const Vec3f d : {Vec3f{0, 1, 0},
                              {0, 0, 0},
                              {1e30f, 1e30f, 1e30f},
                              {1e-30f, 0, 0},
                              {kNanF, 0, 0},
                              {0, kInfinity, 0}})
            CHECK(is_finite(sky.radiance(d)));
        CHECK(sky.latlong(-3, 4).empty());
    }
}
