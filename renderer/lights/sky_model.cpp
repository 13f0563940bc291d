#include "renderer/lights/sky_model.h"

#include <cmath>

#include "renderer/core/fast_math.h"
#include "renderer/lights/atmosphere.h"
#include "renderer/lights/map_projection.h"

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr double kEye_km = 0.2;
constexpr int kSkyRings = 40, kGroundRings = 20, kRings = kSkyRings + kGroundRings, kSectors = 32;
const Vec3d kEye{0, kPlanetRadius_km + kEye_km, 0};

double horizon() { return -std::acos(kPlanetRadius_km / kEye.y); }
const auto kHorizon = static_cast<float>(horizon());

double clamped(double x, double low, double high, double otherwise) {
    return std::isfinite(x) ? std::clamp(x, low, high) : otherwise;
}

float gas_phase(float cos) { return 3.0f / 16.0f * kInvPi * (1.0f + cos * cos); }

// Cornette & Shanks, "Physically reasonable analytic expression for the single-scattering phase
// function", Applied Optics 31(16), 1992.
float haze_phase(float cos) {
    constexpr float kG = 0.8f, kFront = 1.5f * (1.0f - kG * kG) / (2.0f + kG * kG);
    const float d = 1.0f + kG * kG - 2.0f * kG * cos;
    return 0.25f * kInvPi * kFront * (1.0f + cos * cos) / (d * std::sqrt(d));
}

// Rings crowd at the horizon, ring kSkyRings - 1, where the sky changes fastest. The next one is
// at the horizon too: the ground begins.
double ring_elevation(int ring) {
    if (ring < kSkyRings) {
        const double t = 1 - ring / (kSkyRings - 1.0);
        return horizon() + (0.5 * kPiD - horizon()) * t * t;
    }
    const double t = (ring - kSkyRings + 1.0) / kGroundRings;
    return horizon() - (0.5 * kPiD + horizon()) * t * t;
}

Vec3d direction_at(double elevation, double azimuth) {
    return {std::cos(elevation) * std::cos(azimuth), std::sin(elevation),
            std::cos(elevation) * std::sin(azimuth)};
}

// Mean over strips of the disc as they rise one above the other.
Spectrum disc_transmittance(const Atmosphere& air, double elevation, double half_angle) {
    constexpr int kStrips = 16;
    Spectrum sum(0.0f);
    double widths = 0;
    for (int i = 0; i < kStrips; ++i) {
        const double t = 2 * (i + 0.5) / kStrips - 1, width = std::sqrt(1 - t * t);
        sum += air.transmittance(kEye, direction_at(elevation + t * half_angle, 0),
                                 half_angle / kStrips) *
               static_cast<float>(width);
        widths += width;
    }
    return sum * static_cast<float>(1 / widths);
}

// Of a node in the sums over the sky: its ring's height times its sector's width, both half at the
// ends; azimuths beyond half a turn are mirror images.
double node_solid_angle(int ring, int sector) {
    const double above = ring_elevation(std::max(ring - 1, 0)),
                 below = ring_elevation(std::min(ring + 1, kSkyRings - 1));
    const bool last = sector == 0 || sector == kSectors - 1;
    return 0.5 * (above - below) * std::cos(ring_elevation(ring)) * 2 * kPiD / (kSectors - 1) *
           (last ? 0.5 : 1.0);
}

Vec3d usable_sun(Vec3d sun) {
    const double l = length(sun);
    return std::isfinite(l) && l > 1e-9 ? sun / l : Vec3d{0, 1, 0};
}

Color usable_albedo(Color c) {
    const auto part = [](float x) { return x > 0.0f ? std::min(x, 1.0f) : 0.0f; };
    return {part(c.x), part(c.y), part(c.z)};
}

}  // namespace

Vec3d sky_direction(double azimuth, double elevation) {
    const double level = std::cos(elevation);
    return {level * std::sin(azimuth), std::sin(elevation), -level * std::cos(azimuth)};
}

SkyModel::SkyModel(const SkySettings& settings) {
    const Vec3d sun = usable_sun(settings.sun);
    const double level = std::hypot(sun.x, sun.z), elevation = std::atan2(sun.y, level);
    sun_ = Vec3f(sun);
    across_ = level > 1e-9 ? Vec3f(Vec3d{sun.x / level, 0, sun.z / level}) : Vec3f{0, 0, -1};
    const double half_angle = clamped(settings.sun_half_angle_deg, 0.01, 10, 0.2665) * kPiD / 180;

    const Spectrum albedo = reflectance_spectrum(usable_albedo(settings.ground_albedo)),
                   power = sunlight();
    // Turned so that the sun stands over +x.
    const Vec3d turned = direction_at(elevation, 0);
    const Atmosphere air(clamped(settings.turbidity, 1.8, 10, 3), albedo, turned, half_angle);

    nodes_.resize(std::size_t{kRings} * kSectors);
    Spectrum on_ground(0.0f);
    for (int i = 0; i < kRings * kSectors; ++i) {
        const int ring = i / kSectors, sector = i % kSectors;
        const Vec3d d = direction_at(ring_elevation(ring), kPiD * sector / (kSectors - 1));
        Atmosphere::Along a = air.along(kEye, d);
        if (ring < kSkyRings) {
            const auto cos = static_cast<float>(dot(d, turned));
            const Spectrum all = a.gas * gas_phase(cos) + a.haze * haze_phase(cos) + a.repeated;
            const double weight = node_solid_angle(ring, sector) * std::max(d.y, 0.0);
            on_ground += all * static_cast<float>(weight);
        } else {
            // All rings of the sky come first: its light on the ground is known.
            a.repeated +=
                a.transmittance * albedo * (air.direct_on_ground(a.end) + on_ground) * kInvPi;
        }
        nodes_[static_cast<std::size_t>(i)] = {to_rgb(a.gas * power), to_rgb(a.haze * power),
                                               to_rgb(a.repeated * power)};
    }
    sky_irradiance_ = to_rgb(on_ground * power);
    sun_irradiance_ = to_rgb(disc_transmittance(air, elevation, half_angle) * power);
    // The sun at its mean distance sends the same light whatever size it is given.
    const double s = std::sin(0.5 * half_angle);
    sun_radiance_ = sun_irradiance_ * static_cast<float>(1 / (4 * kPiD * s * s));
}

SkyModel::Node SkyModel::look_up(float elevation, float azimuth) const {
    const float above = elevation - kHorizon;
    const float ring =
        above >= 0.0f
            ? (kSkyRings - 1) * (1.0f - std::sqrt(std::min(above / (0.5f * kPi - kHorizon), 1.0f)))
            : (kSkyRings - 1) +
                  kGroundRings * std::sqrt(std::min(-above / (0.5f * kPi + kHorizon), 1.0f));
    const float sector = clamp01(azimuth * kInvPi) * (kSectors - 1);
    const int i = std::min(static_cast<int>(ring), kRings - 2),
              k = std::min(static_cast<int>(sector), kSectors - 2);
    const float tr = ring - static_cast<float>(i), ts = sector - static_cast<float>(k);
    const Node* n = &nodes_[std::size_t(i) * kSectors + k];
    const auto blend = [&](Color Node::*c) {
        return lerp(lerp(n[0].*c, n[1].*c, ts), lerp(n[kSectors].*c, n[kSectors + 1].*c, ts), tr);
    };
    return {blend(&Node::gas), blend(&Node::haze), blend(&Node::even)};
}

Color SkyModel::radiance(Vec3f d) const {
    const float level = std::sqrt(d.x * d.x + d.z * d.z);
    if (!std::isfinite(level * d.y)) return Color(0.0f);
    const float elevation = 2.0f * kPi * atan2_turn(d.y, level);
    const float toward = level > 0.0f ? dot(d, across_) / level : 1.0f;
    const Node n = look_up(elevation, acos_poly(toward));
    const float cos = std::clamp(dot(d, sun_), -1.0f, 1.0f);
    return n.gas * gas_phase(cos) + n.haze * haze_phase(cos) + n.even;
}

std::vector<Color> SkyModel::latlong(int width, int height) const {
    std::vector<Color> map;
    if (width <= 0 || height <= 0) return map;
    map.reserve(std::size_t(width) * height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            map.push_back(radiance(
                latlong_direction({(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                   (static_cast<float>(y) + 0.5f) / static_cast<float>(height)})));
        }
    }
    return map;
}

}  // namespace tessera
