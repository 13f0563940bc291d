#include "renderer/lights/atmosphere.h"

#include <cmath>

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr double kAir_km = kAirTop_km - kPlanetRadius_km;
constexpr double kGasScale_km = 8, kHazeScale_km = 1.2;
constexpr int kColumnHeights = 28, kColumnCosines = 48;
constexpr int kHeights = 14, kElevations = 15, kGroundElevations = 25;
// Along no ray through the air does the sun's elevation change by more: acos(6360 / 6460).
constexpr double kReach = 0.178;
constexpr int kViewSteps = 32, kRepeatedSteps = 14;

double sqr_d(double x) { return x * x; }

// Ozone lies in a layer around 25 km, of density 1 at its peak.
double ozone_density(double height) { return std::max(0.0, 1 - std::abs(height - 25) / 15); }

// Vertical optical thickness of clean air. Hansen & Travis, "Light Scattering in Planetary
// Atmospheres", Space Science Reviews 16, 1974; micrometres.
double gas_thickness(double um) {
    const double q = 1 / (um * um);
    return 0.008569 * q * q * (1 + 0.0113 * q + 0.00013 * q * q);
}

// The same of haze. Preetham, Shirley, Smits, "A Practical Analytic Model for Daylight", SIGGRAPH
// 1999, appendix A.1 (after Angstrom).
double haze_thickness(double turbidity, double um) {
    return std::max(0.0, 0.04608 * turbidity - 0.04586) * std::pow(um, -1.3);
}

// The same of 300 Dobson units of ozone: the Chappuis band as one bell, our fit to its peak of
// 5e-21 cm^2 and its half width.
double ozone_thickness(double um) {
    constexpr double kColumn_cm2 = 300 * 2.687e16;
    return kColumn_cm2 * 5e-21 * std::exp(-0.5 * sqr_d((um - 0.595) / 0.052));
}

constexpr double kHazeAlbedo = 0.92;  // what haze scatters of what it takes
// Light on its way from its first scattering takes the haze's forward peak for no scattering, and
// the rest as even to all sides. The peak is g^2 of the whole, g = 0.8: Joseph, Wiscombe, Weinman,
// "The Delta-Eddington Approximation for Radiative Flux Transfer", J. Atmos. Sci. 33, 1976.
constexpr double kForwardPeak = 0.64;

template <class F>
Spectrum over_wavelengths(F f) {
    return Spectrum::map([&](int i) { return static_cast<float>(f(wavelength_nm(i) * 1e-3)); });
}

// A place in a table of n nodes, t in [0, 1].
struct Between {
    int i;
    double t;
    Between(double x, int n) {
        const double at = (x > 0 ? std::min(x, 1.0) : 0.0) * (n - 1);
        i = std::min(static_cast<int>(at), n - 2);
        t = at - i;
    }
};

// Nodes crowd in the haze near the ground.
double node_height(int i, int n) { return kAir_km * sqr_d(sqr_d(i / (n - 1.0))); }
double height_place(double radius) {
    return std::sqrt(std::sqrt(std::max(0.0, radius - kPlanetRadius_km) / kAir_km));
}

Spectrum blend(const std::vector<Spectrum>& table, std::size_t first, double t) {
    return lerp(table[first], table[first + 1], static_cast<float>(t));
}

// (1 - exp(-x)) / x, given exp(-x).
Spectrum mean_transmittance(const Spectrum& x, const Spectrum& exp_x) {
    return Spectrum::map([&](int i) {
        return x[i] < 0.01f ? 1.0f - x[i] * (0.5f - x[i] * 0.16666667f) : (1.0f - exp_x[i]) / x[i];
    });
}

Vec3d sun_at(double elevation) { return {std::cos(elevation), std::sin(elevation), 0}; }

}  // namespace

Atmosphere::Atmosphere(double turbidity, const Spectrum& ground, Vec3d sun, double half_angle)
    : gas_(over_wavelengths([](double um) { return gas_thickness(um) / kGasScale_km; })),
      haze_extinction_(over_wavelengths(
          [&](double um) { return haze_thickness(turbidity, um) / kHazeScale_km; })),
      // The layer's column is its half width.
      ozone_(over_wavelengths([](double um) { return ozone_thickness(um) / 15; })),
      ground_(ground),
      sun_(sun),
      sun_elevation_(std::atan2(sun.y, std::hypot(sun.x, sun.z))),
      half_angle_(half_angle) {
    haze_ = haze_extinction_ * static_cast<float>(kHazeAlbedo);
    haze_even_ = haze_ * static_cast<float>(1 - kForwardPeak);
    haze_even_extinction_ = haze_extinction_ * static_cast<float>(1 - kHazeAlbedo * kForwardPeak);
    fill_columns();
    fill_repeated();
}

Atmosphere::Columns Atmosphere::density(double height) {
    const double h = std::max(height, 0.0);
    return {std::exp(-h / kGasScale_km), std::exp(-h / kHazeScale_km), ozone_density(h)};
}

double Atmosphere::horizon_cosine(double radius) {
    return -std::sqrt(std::max(0.0, 1 - sqr_d(kPlanetRadius_km / radius)));
}

Spectrum Atmosphere::extinction(Columns c, const Spectrum& haze) const {
    return (gas_ * static_cast<float>(c.gas)) + (haze * static_cast<float>(c.haze)) +
           (ozone_ * static_cast<float>(c.ozone));
}

void Atmosphere::fill_columns() {
    // From the ray's lowest point (or its start) outward, in steps that grow.
    const auto integrate = [](double lowest, double from, double to) {
        constexpr int kSteps = 40;
        Columns sum{};
        for (int k = 0; k < kSteps; ++k) {
            const double a = sqr_d(double(k) / kSteps), b = sqr_d((k + 1.0) / kSteps);
            const double s = from + (to - from) * 0.5 * (a + b);
            sum = sum + density(std::hypot(lowest, s) - kPlanetRadius_km) * ((to - from) * (b - a));
        }
        return sum;
    };
    for (int i = 0; i < kColumnHeights; ++i) {
        const double r = kPlanetRadius_km + node_height(i, kColumnHeights);
        const double lowest_cosine = horizon_cosine(r);
        for (int k = 0; k < kColumnCosines; ++k) {
            const double c =
                lowest_cosine + (1 - lowest_cosine) * sqr_d(k / (kColumnCosines - 1.0));
            const double start = r * c, lowest = r * std::sqrt(std::max(0.0, 1 - c * c));
            const double top = std::sqrt(std::max(0.0, sqr_d(kAirTop_km) - sqr_d(lowest)));
            columns_.push_back(start < 0 ? integrate(lowest, 0, -start) + integrate(lowest, 0, top)
                                         : integrate(lowest, start, top));
        }
    }
}

Atmosphere::Columns Atmosphere::column_up(double radius, double cosine) const {
    const double lowest = horizon_cosine(radius);
    const Between h(height_place(radius), kColumnHeights);
    const Between c(std::sqrt(std::max(0.0, (cosine - lowest) / (1 - lowest))), kColumnCosines);
    const auto at = [&](int i) {
        const Columns* row = &columns_[std::size_t(i) * kColumnCosines + c.i];
        return row[0] * (1 - c.t) + row[1] * c.t;
    };
    return at(h.i) * (1 - h.t) + at(h.i + 1) * h.t;
}

Spectrum Atmosphere::transmittance(Vec3d position, Vec3d direction, double softness) const {
    const double r = length(position), c = dot(position, direction) / r, lowest = horizon_cosine(r);
    const double above = (c - lowest) / (2 * softness) + 0.5;
    if (above <= 0) return Spectrum(0.0f);
    const double t = std::min(above, 1.0);
    return exp_minus(extinction(column_up(r, c), haze_extinction_)) *
           static_cast<float>(t * t * (3 - 2 * t));
}

// Calls visit(densities, light that a unit source there sends back, position) for every step.
template <class Visit>
Atmosphere::Along Atmosphere::walk(Vec3d origin, Vec3d direction, int steps, Visit visit) const {
    Along a;
    const double b = dot(origin, direction), r2 = dot(origin, origin);
    const double to_ground = sqr_d(b) - r2 + sqr_d(kPlanetRadius_km);
    a.ground = b < 0 && to_ground > 0;
    const double far = a.ground ? std::max(0.0, -b - std::sqrt(to_ground))
                                : -b + std::sqrt(std::max(0.0, sqr_d(b) - r2 + sqr_d(kAirTop_km)));
    for (int k = 0; k < steps; ++k) {
        const double from = far * sqr_d(double(k) / steps), to = far * sqr_d((k + 1.0) / steps);
        const Vec3d p = origin + direction * (0.5 * (from + to));
        const Columns d = density(length(p) - kPlanetRadius_km);
        const auto step = static_cast<float>(to - from);
        const Spectrum thickness = extinction(d, haze_even_extinction_) * step,
                       passed = exp_minus(thickness);
        visit(d, a.transmittance * mean_transmittance(thickness, passed) * step, p);
        a.transmittance *= passed;
    }
    a.end = origin + direction * far;
    return a;
}

Atmosphere::Along Atmosphere::along(Vec3d origin, Vec3d direction) const {
    Spectrum gas(0.0f), haze(0.0f), repeated(0.0f);
    Along a = walk(origin, direction, kViewSteps, [&](Columns d, const Spectrum& seen, Vec3d p) {
        const Spectrum by_gas = gas_ * seen * static_cast<float>(d.gas),
                       by_haze = haze_ * seen * static_cast<float>(d.haze);
        const Spectrum lit = toward_sun(p, sun_);
        gas += by_gas * lit;
        haze += by_haze * lit;
        repeated += (by_gas + haze_even_ * seen * static_cast<float>(d.haze)) * repeated_at(p);
    });
    a.gas = gas, a.haze = haze, a.repeated = repeated;
    return a;
}

Spectrum Atmosphere::direct_on_ground(Vec3d position) const {
    const double c = dot(position, sun_) / length(position);
    return toward_sun(position, sun_) * static_cast<float>(std::max(c, 0.0));
}

double Atmosphere::node_elevation(int k, int n, double reach) const {
    return sun_elevation_ + reach * (2.0 * k / (n - 1) - 1);
}

// Irradiance of level ground by the sun and by light scattered once, evenly to all sides; and the
// same by light of radiance 1 at every place that scatters.
Atmosphere::GroundLight Atmosphere::light_on_ground(double elevation) const {
    const Vec3d sun = sun_at(elevation), up{0, kPlanetRadius_km, 0};
    GroundLight g{toward_sun(up, sun) * static_cast<float>(std::max(sun.y, 0.0)), Spectrum(0.0f)};
    constexpr int kRings = 6, kSectors = 2;
    for (int k = 0; k < kRings * kSectors; ++k) {
        const int ring = k / kSectors, sector = k % kSectors;
        // Even in cos^2: each carries the same share of a Lambertian's irradiance, pi in all.
        const double c = std::sqrt((ring + 0.5) / kRings), s = std::sqrt(1 - c * c);
        const double phi = kPiD * (sector + 0.5) / kSectors;
        Spectrum once(0.0f), all(0.0f);
        walk(up, {s * std::cos(phi), c, s * std::sin(phi)}, kRepeatedSteps,
             [&](Columns d, const Spectrum& seen, Vec3d p) {
                 once += scattering(d, haze_) * seen * toward_sun(p, sun);
                 all += scattering(d, haze_even_) * seen;
             });
        constexpr auto kShare = static_cast<float>(kPiD / (kRings * kSectors));
        g.irradiance += once * (kShare * static_cast<float>(0.25 / kPiD));
        g.of_unit += all * kShare;
    }
    return g;
}

Spectrum Atmosphere::scattering(Columns d, const Spectrum& haze) const {
    return gas_ * static_cast<float>(d.gas) + haze * static_cast<float>(d.haze);
}

// Multiple scattering of Hillaire 2020: all light after the first scattering is taken as even in
// direction and as alike nearby, so that orders form a geometric series. Beyond the paper the
// ground takes part in every order, and the haze's forward peak in none.
void Atmosphere::fill_repeated() {
    std::vector<Spectrum> on_ground;
    for (int k = 0; k < kGroundElevations; ++k)
        on_ground.push_back(
            light_on_ground(node_elevation(k, kGroundElevations, 2 * kReach)).irradiance);
    const Spectrum of_unit = light_on_ground(sun_elevation_).of_unit;
    const Spectrum reflected = ground_ * static_cast<float>(1 / kPiD);

    constexpr int kRings = 12, kSectors = 3;
    for (int i = 0; i < kHeights * kElevations; ++i) {
        const double height = node_height(i / kElevations, kHeights);
        const Vec3d sun = sun_at(node_elevation(i % kElevations, kElevations, kReach));
        Spectrum second(0.0f), kept(0.0f);
        for (int k = 0; k < kRings * kSectors; ++k) {
            const int ring = k / kSectors, sector = k % kSectors;
            const double c = 2 * (ring + 0.5) / kRings - 1, s = std::sqrt(1 - c * c);
            const double phi = kPiD * (sector + 0.5) / kSectors;
            const Along a =
                walk({0, kPlanetRadius_km + height, 0}, {s * std::cos(phi), c, s * std::sin(phi)},
                     kRepeatedSteps, [&](Columns d, const Spectrum& seen, Vec3d p) {
                         second += scattering(d, haze_) * seen * toward_sun(p, sun) *
                                   static_cast<float>(0.25 / kPiD);
                         kept += scattering(d, haze_even_) * seen;
                     });
            if (!a.ground) continue;
            const double elevation =
                std::asin(std::clamp(dot(a.end, sun) / length(a.end), -1.0, 1.0));
            const Between b((elevation - sun_elevation_) / (4 * kReach) + 0.5, kGroundElevations);
            const Spectrum back = a.transmittance * reflected;
            second += back * blend(on_ground, static_cast<std::size_t>(b.i), b.t);
            kept += back * of_unit;
        }
        constexpr float kShare = 1.0f / (kRings * kSectors);
        repeated_.push_back(Spectrum::map([&](int w) {
            return second[w] * kShare / (1.0f - std::min(kept[w] * kShare, 0.98f));
        }));
    }
}

Spectrum Atmosphere::repeated_at(Vec3d position) const {
    const double r = length(position);
    const double elevation = std::asin(std::clamp(dot(position, sun_) / r, -1.0, 1.0));
    const Between h(height_place(r), kHeights);
    const Between e((elevation - sun_elevation_) / (2 * kReach) + 0.5, kElevations);
    const auto at = [&](int i) {
        return blend(repeated_, std::size_t(i) * kElevations + e.i, e.t);
    };
    return lerp(at(h.i), at(h.i + 1), static_cast<float>(h.t));
}

}  // namespace tessera
