#pragma once
// Sky, sun and ground of a clear day, computed from the air rather than fitted to measurements.
// Radiance in visible watts per m^2 and sr, linear Rec.709: see visible_spectrum.h. Full sun at
// noon gives level ground about 450 of them per m^2, which is about 1000 W/m^2 of sunlight in all,
// or 100 klx. The sun's distance is its mean over the year; refraction is left out.

#include <vector>

#include "renderer/core/vec.h"

namespace tessera {

struct SkySettings {
    double turbidity = 3;  // 1.8 is the clearest air, 10 thick haze; clamped to that
    Color ground_albedo{0.2f};
    Vec3d sun{0, 1, 0};  // unit vector toward it
    double sun_half_angle_deg = 0.2665;
};

/// Toward azimuth, radians from north (-z) by east (+x), as a compass has it, and elevation.
Vec3d sky_direction(double azimuth, double elevation);

class SkyModel {
public:
    /// A few hundredths of a second. What is not finite or out of range is clamped.
    explicit SkyModel(const SkySettings& settings);

    /// Without the sun's disc. The eye is 200 m up: the horizon lies 0.45 degrees below the level
    /// and is as hazy as from there. d: unit vector; black if it is not finite.
    Color radiance(Vec3f d) const;
    /// Of the sun's disc, its mean; 0 once it is set.
    Color sun_radiance() const { return sun_radiance_; }
    /// Of a surface that faces the sun, by its disc alone.
    Color sun_irradiance() const { return sun_irradiance_; }
    /// Of level ground by the sky alone.
    Color sky_irradiance() const { return sky_irradiance_; }

    /// A lat-long map without the sun's disc, rows from the top, north in the middle.
    std::vector<Color> latlong(int width, int height) const;

private:
    // What the phase functions are to be multiplied with, and the rest.
    struct Node {
        Color gas, haze, even;
    };
    Node look_up(float elevation, float azimuth) const;

    Vec3f sun_, across_;  // across_: level, toward the sun
    Color sun_radiance_, sun_irradiance_, sky_irradiance_;
    std::vector<Node> nodes_;  // rings from the zenith's to the horizon's and on to the nadir's
};

}  // namespace tessera
