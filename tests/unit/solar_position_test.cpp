#include "renderer/lights/solar_position.h"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

using namespace tessera;

namespace {

// Local noon: when the sun stands highest, by the equation of time.
double noon_elevation(double latitude, double longitude, SolarTime t) {
    t.hour = 12 - longitude / 15;
    t.hour -= solar_position(latitude, longitude, t).equation_of_time_min / 60;
    return solar_position(latitude, longitude, t).elevation_deg;
}

}  // namespace

TEST_CASE("solar position: at noon of a solstice the sun stands at 90 - latitude +- 23.44") {
    // The declination stays within 0.01 degrees of its extreme for a day.
    for (const double longitude : {-120.0, 0.0, 13.4}) {
        for (const double latitude : {30.0, 47.0, 60.0}) {
            CHECK(std::abs(noon_elevation(latitude, longitude, {2024, 6, 20, 0}) -
                           (90 - latitude + 23.44)) < 0.02);
            CHECK(std::abs(noon_elevation(latitude, longitude, {2024, 12, 21, 0}) -
                           (90 - latitude - 23.44)) < 0.02);
            CHECK(std::abs(noon_elevation(-latitude, longitude, {2024, 12, 21, 0}) -
                           (90 - latitude + 23.44)) < 0.02);
        }
    }
}

TEST_CASE("solar position: equinoxes and solstices fall on their published minute") {
    // March 2000, 20th, 07:35 UT; September 2024, 22nd, 12:44 UT. A minute is 0.0003 degrees of
    // declination; the method is good to 0.01 degrees of longitude, 0.004 of declination.
    CHECK(std::abs(solar_position(0, 0, {2000, 3, 20, 7 + 35 / 60.0}).declination_deg) < 0.005);
    CHECK(std::abs(solar_position(0, 0, {2024, 9, 22, 12 + 44 / 60.0}).declination_deg) < 0.005);
    // Meeus, example 25.a: 13 October 1992, 0h TD, apparent declination -7.78507.
    CHECK(std::abs(solar_position(0, 0, {1992, 10, 13, 0}).declination_deg + 7.78507) < 0.001);
}

TEST_CASE("solar position: at an equinox the sun rises in the east and sets in the west") {
    for (const double latitude : {-50.0, 0.0, 35.0}) {
        // Six hours from noon; the sun moves by 15 degrees in an hour, elevation follows.
        const double eot = solar_position(latitude, 0, {2024, 3, 20, 6}).equation_of_time_min / 60;
        const SolarPosition rise = solar_position(latitude, 0, {2024, 3, 20, 6 - eot}),
                            set = solar_position(latitude, 0, {2024, 3, 20, 18 - eot});
        // The declination changes by 0.016 degrees an hour, the equinox is at 03:06.
        CHECK(std::abs(rise.elevation_deg) < 0.3);
        CHECK(std::abs(rise.azimuth_deg - 90) < 0.3);
        CHECK(std::abs(set.azimuth_deg - 270) < 0.5);
    }
}

TEST_CASE("solar position: the equation of time has its extremes in November and February") {
    double most = -100, least = 100;
    int most_day = 0, least_day = 0;
    for (int day = 1; day <= 366; ++day) {
        // Days of January past the 31st are those of the months that follow.
        const double e = solar_position(0, 0, {2024, 1, day, 12}).equation_of_time_min;
        if (e > most) most = e, most_day = day;
        if (e < least) least = e, least_day = day;
    }
    CHECK(std::abs(most - 16.4) < 0.1);
    CHECK(std::abs(least + 14.2) < 0.1);
    CHECK(std::abs(most_day - 308) <= 2);  // 3 November of a leap year
    CHECK(std::abs(least_day - 42) <= 2);  // 11 February
}

TEST_CASE("solar position: the sky turns by the clock, and longitude is time") {
    const SolarPosition a = solar_position(40, 0, {2024, 5, 1, 15}),
                        b = solar_position(40, 15, {2024, 5, 1, 14}),
                        c = solar_position(40, 0, {2024, 4, 30, 39});
    // An hour changes the declination by 0.013 degrees.
    CHECK(std::abs(a.elevation_deg - b.elevation_deg) < 0.02);
    CHECK(std::abs(a.azimuth_deg - b.azimuth_deg) < 0.02);
    CHECK(a.elevation_deg == doctest::Approx(c.elevation_deg));
    CHECK(a.azimuth_deg > 180);  // afternoon in the north: in the west
    CHECK(solar_position(90, 0, {2024, 5, 1, 3}).elevation_deg ==
          doctest::Approx(solar_position(90, 0, {2024, 5, 1, 3}).declination_deg));
}

TEST_CASE("solar position: senseless input gives no trap and no finite lie") {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    CHECK_FALSE(std::isfinite(solar_position(nan, 0, {2024, 1, 1, 1}).elevation_deg));
    CHECK_FALSE(std::isfinite(solar_position(0, inf, {2024, 1, 1, 1}).elevation_deg));
    CHECK_FALSE(std::isfinite(solar_position(0, 0, {2024, 1, 1, nan}).elevation_deg));
    CHECK(std::isfinite(solar_position(1e30, -1e30, {-2147483647 - 1, 99, -7, 1e9}).elevation_deg));
}
