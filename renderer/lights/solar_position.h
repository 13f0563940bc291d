#pragma once
// Where the sun stands, by place and time. To 0.01 degrees between 1950 and 2050; refraction, which
// lifts a setting sun by 0.6 degrees, is left out.
// Meeus, "Astronomical Algorithms", 2nd ed., 1998, chapters 7, 12, 13, 22, 25 and 28 (the method of
// NOAA's solar calculator).

namespace tessera {

/// In UTC by the Gregorian calendar. Any hour, negative ones and those past 24 too.
struct SolarTime {
    int year = 2000, month = 1, day = 1;
    double hour = 12;
};

struct SolarPosition {
    double elevation_deg = 0;
    double azimuth_deg = 0;  // from north by east, [0, 360)
    double declination_deg = 0;
    double equation_of_time_min = 0;  // sundial less clock
};

/// latitude: north is positive, [-90, 90]; longitude: east is positive. What is not finite gives
/// what is not finite.
SolarPosition solar_position(double latitude_deg, double longitude_deg, const SolarTime& utc);

}  // namespace tessera
