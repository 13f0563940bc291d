#include "renderer/lights/solar_position.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

double sin_deg(double a) { return std::sin(a * kDegree); }
double cos_deg(double a) { return std::cos(a * kDegree); }
// In [0, 360).
double whole_turn(double a) {
    const double t = a - 360 * std::floor(a / 360);
    return t < 360 ? t : 0;
}

// Days since noon of 1 January 2000. Meeus eq. 7.1.
double days_since_2000(const SolarTime& t) {
    double year = t.year, month = t.month;
    if (month <= 2) year -= 1, month += 12;
    const double century = std::floor(year / 100);
    const double leap = 2 - century + std::floor(century / 4);
    return std::floor(365.25 * (year + 4716)) + std::floor(30.6001 * (month + 1)) + t.day + leap -
           1524.5 - 2451545.0 + t.hour / 24;
}

struct OnTheSky {
    double right_ascension, declination, mean_longitude, nutation, obliquity;  // degrees
};

// Meeus chapter 25, low accuracy; t in Julian centuries.
OnTheSky sun_on_the_sky(double t) {
    const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
    const double anomaly = 357.52911 + t * (35999.05029 - t * 0.0001537);
    const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * sin_deg(anomaly) +
                          (0.019993 - t * 0.000101) * sin_deg(2 * anomaly) +
                          0.000289 * sin_deg(3 * anomaly);
    const double node = 125.04 - 1934.136 * t;
    const double nutation = -0.00478 * sin_deg(node);
    const double longitude = mean_longitude + centre - 0.00569 + nutation;
    const double obliquity = 23.0 + 26.0 / 60 + 21.448 / 3600 -
                             t * (46.8150 + t * (0.00059 - t * 0.001813)) / 3600 +
                             0.00256 * cos_deg(node);
    return {std::atan2(cos_deg(obliquity) * sin_deg(longitude), cos_deg(longitude)) / kDegree,
            std::asin(std::clamp(sin_deg(obliquity) * sin_deg(longitude), -1.0, 1.0)) / kDegree,
            mean_longitude, nutation, obliquity};
}

}  // namespace

SolarPosition solar_position(double latitude_deg, double longitude_deg, const SolarTime& utc) {
    const double days = days_since_2000(utc), t = days / 36525;
    const OnTheSky sun = sun_on_the_sky(t);
    // Meeus eqs. 12.4 and 13.5, 13.6; his azimuth is from south, ours from north.
    const double sidereal = 280.46061837 + 360.98564736629 * days + t * t * 0.000387933 +
                            sun.nutation * cos_deg(sun.obliquity);
    const double hour = sidereal + longitude_deg - sun.right_ascension;
    const double up = sin_deg(latitude_deg) * sin_deg(sun.declination) +
                      cos_deg(latitude_deg) * cos_deg(sun.declination) * cos_deg(hour);
    const double east = -cos_deg(sun.declination) * sin_deg(hour);
    const double north = cos_deg(latitude_deg) * sin_deg(sun.declination) -
                         sin_deg(latitude_deg) * cos_deg(sun.declination) * cos_deg(hour);
    // Meeus eq. 28.1, folded to half a turn; 4 minutes each degree.
    const double ahead = whole_turn(sun.mean_longitude - 0.0057183 - sun.right_ascension +
                                    sun.nutation * cos_deg(sun.obliquity) + 180) -
                         180;
    return {std::atan2(up, std::hypot(east, north)) / kDegree,
            whole_turn(std::atan2(east, north) / kDegree), sun.declination, 4 * ahead};
}

}  // namespace tessera
