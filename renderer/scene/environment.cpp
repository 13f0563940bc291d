#include "renderer/scene/environment.h"

#include <fmt/format.h>

#include <cmath>

#include "renderer/lights/sky_model.h"
#include "renderer/lights/solar_position.h"
#include "renderer/scene/map_file.h"

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kSkyHeight = 512;

Color color_of(const Float3& c) { return {c[0], c[1], c[2]}; }

/// How the image that a key names is read.
MapFile map_of(const EnvironmentDesc& desc, const std::string& key, const SourceLoc& loc) {
    return {"environment: " + key, loc.file ? loc : desc.loc, desc.projection,
            desc.color_space,      color_of(desc.radiance),   desc.rotate_deg};
}

std::shared_ptr<const LatLongMap> own_map(const std::string& file, const MapFile& how,
                                          const EmitterInput& in) {
    if (file.empty()) return nullptr;
    auto map = read_map(how, file, *in.colors, in.problems);
    return map ? std::make_shared<const LatLongMap>(std::move(*map)) : nullptr;
}

// What surfaces are lit by; constant without a file.
std::optional<LatLongMap> lighting_map(const EnvironmentDesc& desc, const EmitterInput& in) {
    if (!desc.lighting.empty())
        return read_map(map_of(desc, "lighting", desc.lighting_loc), desc.lighting, *in.colors,
                        in.problems);
    if (!desc.faces.empty())
        return read_faces(map_of(desc, "faces", desc.faces_loc), desc.faces, *in.colors,
                          in.problems);
    if (!desc.file.empty())
        return read_map(map_of(desc, "file", desc.file_loc), desc.file, *in.colors, in.problems);
    LatLongMap map;
    map.scale = color_of(desc.radiance);
    return map;
}

// What the others fall back to where lighting has an image of its own.
std::shared_ptr<const LatLongMap> common_map(const EnvironmentDesc& desc, const EmitterInput& in) {
    EnvironmentDesc common = desc;
    common.lighting.clear();
    auto map = lighting_map(common, in);
    return map ? std::make_shared<const LatLongMap>(std::move(*map)) : nullptr;
}

}  // namespace

std::optional<Light> make_environment(const EnvironmentDesc& desc, const EmitterInput& in) {
    if (!(max_component(color_of(desc.radiance)) > 0.0f) && !has_image(desc)) return std::nullopt;
    auto map = lighting_map(desc, in);
    if (!map) return std::nullopt;
    EnvironmentLight light = make_environment(std::move(*map), desc.visible);
    light.camera = own_map(desc.camera, map_of(desc, "camera", desc.camera_loc), in);
    light.reflection =
        own_map(desc.reflection, map_of(desc, "reflection", desc.reflection_loc), in);
    if (!desc.lighting.empty() && (!light.camera || !light.reflection)) {
        const auto common = common_map(desc, in);
        if (!light.camera) light.camera = common;
        if (!light.reflection) light.reflection = common;
    }
    return light;
}

std::vector<Light> make_sky(const SkyDesc& desc, const EmitterInput& in) {
    double elevation = desc.sun_elevation_deg, azimuth = desc.sun_azimuth_deg;
    if (desc.when) {
        const auto& t = *desc.when;
        const SolarPosition sun =
            solar_position(t.latitude_deg, t.longitude_deg, {t.year, t.month, t.day, t.hour});
        elevation = sun.elevation_deg, azimuth = sun.azimuth_deg;
        in.problems.note(desc.loc, fmt::format("sky: the sun stands at elevation {:.1f}, azimuth "
                                               "{:.1f} degrees",
                                               elevation, azimuth));
    }
    SkySettings settings;
    settings.turbidity = desc.turbidity;
    settings.ground_albedo = color_of(desc.ground_albedo);
    settings.sun = sky_direction(azimuth * kPiD / 180, elevation * kPiD / 180);
    settings.sun_half_angle_deg = 0.5 * desc.sun_angle_deg;
    const SkyModel model(settings);
    // The model's watts are of 215 lumens, those of our lights of kLumensPerWatt: nits agree.
    constexpr float kUnit = 215.0f / kLumensPerWatt;
    const Color factor(desc.intensity * kUnit);
    std::vector<Light> lights;
    std::vector<Color> texels = model.latlong(2 * kSkyHeight, kSkyHeight);
    in.colors->to_working({&texels[0].x, texels.size() * 3}, "lin_rec709");
    for (Color& c : texels) c = max(c, Color(0.0f));
    lights.emplace_back(
        make_environment(2 * kSkyHeight, kSkyHeight, std::move(texels), factor, 0, desc.visible));
    Color irradiance = model.sun_irradiance() * factor;
    if (!desc.sun || !(max_component(irradiance) > 0.0f)) return lights;
    in.colors->to_working({&irradiance.x, 3}, "lin_rec709");
    lights.emplace_back(make_distant_light(Vec3f(settings.sun), max(irradiance, Color(0.0f)),
                                           desc.sun_angle_deg, desc.visible));
    return lights;
}

}  // namespace tessera
