#pragma once
// Air around a round planet: gas, haze and ozone in spherical shells, light scattered in it once,
// and what further scattering adds. Lengths in km. No refraction.
// Bruneton & Neyret, "Precomputed Atmospheric Scattering", EGSR 2008; Hillaire, "A Scalable and
// Production Ready Sky and Atmosphere Rendering Technique", EGSR 2020.

#include <vector>

#include "renderer/lights/visible_spectrum.h"

namespace tessera {

inline constexpr double kPlanetRadius_km = 6360, kAirTop_km = 6460;

class Atmosphere {
public:
    /// turbidity: optical thickness of gas and haze over that of gas alone. Ground: reflectance.
    /// sun: unit, up is y. half_angle: of the sun's disc, radians.
    Atmosphere(double turbidity, const Spectrum& ground, Vec3d sun, double half_angle);

    /// Light that comes along a ray per light of the sun that arrives at the air, 1/sr, but for the
    /// phase function of what is named; and what is left of the light behind.
    struct Along {
        Spectrum gas = Spectrum(0.0f), haze = gas, repeated = gas, transmittance = Spectrum(1.0f);
        bool ground = false;
        Vec3d end;  // from the planet's centre
    };
    Along along(Vec3d origin, Vec3d direction) const;

    /// To the end of the air; fades out over the horizon, over +- softness, radians.
    Spectrum transmittance(Vec3d position, Vec3d direction, double softness) const;
    /// Irradiance of the ground by the sun's disc, per light of the sun.
    Spectrum direct_on_ground(Vec3d position) const;

private:
    struct Columns {
        double gas, haze, ozone;
        Columns operator+(Columns b) const { return {gas + b.gas, haze + b.haze, ozone + b.ozone}; }
        Columns operator*(double s) const { return {gas * s, haze * s, ozone * s}; }
    };
    struct GroundLight {
        Spectrum irradiance, of_unit;
    };
    static Columns density(double height);
    static double horizon_cosine(double radius);
    Spectrum extinction(Columns c, const Spectrum& haze) const;
    Spectrum scattering(Columns d, const Spectrum& haze) const;
    Columns column_up(double radius, double cosine) const;
    double node_elevation(int k, int n, double reach) const;
    GroundLight light_on_ground(double elevation) const;
    Spectrum toward_sun(Vec3d position, Vec3d sun) const {
        return transmittance(position, sun, half_angle_);
    }
    Spectrum repeated_at(Vec3d position) const;
    template <class Visit>
    Along walk(Vec3d origin, Vec3d direction, int steps, Visit visit) const;
    void fill_columns();
    void fill_repeated();

    Spectrum gas_, haze_, haze_extinction_, haze_even_, haze_even_extinction_, ozone_, ground_;
    Vec3d sun_;
    double sun_elevation_, half_angle_;
    std::vector<Columns> columns_;    // from a height toward a cosine to the end of the air
    std::vector<Spectrum> repeated_;  // radiance scattered more than once, per light of the sun
};

}  // namespace tessera
