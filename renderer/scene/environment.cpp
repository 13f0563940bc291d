#include "renderer/scene/environment.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "renderer/image/colour_space.h"
#include "renderer/image/image_io.h"
#include "renderer/lights/map_projection.h"
#include "renderer/lights/map_resample.h"
#include "renderer/lights/sky_model.h"
#include "renderer/lights/solar_position.h"

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kSkyHeight = 512;

Color color_of(const Float3& c) { return {c[0], c[1], c[2]}; }

struct Picture {
    int width = 0, height = 0;
    std::vector<Color> texels;  // in the working space
};

/// Texels that are not finite or negative are taken as 0, with a warning.
Picture read_picture(const std::string& file, const EnvironmentDesc& desc, const EmitterInput& in) {
    const Image image = read_image(file);
    Picture out{image.width, image.height, {}};
    out.texels.resize(std::size_t(image.width) * image.height);
    std::size_t bad = 0;
    for (std::size_t i = 0; i < out.texels.size(); ++i) {
        const float* p = &image.pixels[i * image.channels];
        Color c = image.channels >= 3 ? Color{p[0], p[1], p[2]} : Color(p[0]);
        if (!is_finite(c) || min_component(c) < 0.0f) {
            ++bad;
            c = is_finite(c) ? max(c, Color(0.0f)) : Color(0.0f);
        }
        out.texels[i] = c;
    }
    if (bad > 0)
        in.problems.warn(
            desc.loc,
            fmt::format("environment '{}': {} texels are not finite or negative, taken as 0", file,
                        bad));
    const bool eight_bit = !image_info(file).is_float;
    static_assert(sizeof(Color) == 3 * sizeof(float));
    in.colors->to_working(
        {&out.texels[0].x, out.texels.size() * 3},
        desc.color_space.empty() && eight_bit ? "srgb_texture" : desc.color_space);
    for (Color& c : out.texels) c = is_finite(c) ? max(c, Color(0.0f)) : Color(0.0f);
    return out;
}

MapProjection projection_of(EnvironmentMap map) {
    return static_cast<MapProjection>(static_cast<int>(map) - 1);
}
static_assert(static_cast<int>(EnvironmentMap::angular) - 1 ==
              static_cast<int>(MapProjection::angular));

/// What the picture is; nothing, reported, if that cannot be told. Shapes of no map are latlong, as
/// cropped ones are met.
std::optional<MapProjection> find_projection(const EnvironmentDesc& desc, const Picture& picture,
                                             const EmitterInput& in) {
    const int w = picture.width, h = picture.height;
    if (desc.projection != EnvironmentMap::automatic) {
        const MapProjection p = projection_of(desc.projection);
        if (p == MapProjection::latlong || projection_fits(p, w, h)) return p;
        in.problems.error(desc.loc,
                          fmt::format("environment '{}': {}x{} pixels are not the shape of "
                                      "its projection",
                                      desc.file, w, h));
        return std::nullopt;
    }
    const auto guesses = guess_projection(w, h);
    if (guesses.size() == 1) return guesses[0];
    if (guesses.size() == 2 && w > 1) {
        in.problems.error(
            desc.loc,
            fmt::format("environment '{}': a square picture can be a mirror ball or an "
                        "angular map; say projection = \"mirror_ball\" or \"angular\" (or "
                        "\"latlong\")",
                        desc.file));
        return std::nullopt;
    }
    return MapProjection::latlong;
}

// Texels of the result are about as large as those of the source.
int latlong_height(std::size_t texels) {
    return std::clamp(static_cast<int>(std::sqrt(static_cast<double>(texels) / 2)), 16, 8192);
}

std::optional<Light> from_faces(const EnvironmentDesc& desc, const EmitterInput& in) {
    std::array<Picture, 6> faces;
    std::array<std::span<const Color>, 6> spans;
    for (std::size_t i = 0; i < 6; ++i) {
        faces[i] = read_picture(desc.faces[i], desc, in);
        spans[i] = faces[i].texels;
        if (faces[i].width == faces[0].width && faces[i].height == faces[0].width) continue;
        in.problems.error(desc.loc, fmt::format("environment '{}': faces are squares of one size",
                                                desc.faces[i]));
        return std::nullopt;
    }
    const int size = faces[0].width;
    const int height = latlong_height(std::size_t(size) * std::size_t(size) * 6);
    return make_environment(2 * height, height,
                            resample_to_latlong(CubeFaces::observer, size, spans, height),
                            color_of(desc.radiance), desc.rotate_deg, desc.visible);
}

}  // namespace

std::optional<Light> make_environment(const EnvironmentDesc& desc, const EmitterInput& in) {
    if (desc.file.empty() && desc.faces.empty()) {
        if (!(max_component(color_of(desc.radiance)) > 0.0f)) return std::nullopt;
        return make_constant_environment(color_of(desc.radiance), desc.visible);
    }
    try {
        if (!desc.faces.empty()) return from_faces(desc, in);
        Picture picture = read_picture(desc.file, desc, in);
        const auto projection = find_projection(desc, picture, in);
        if (!projection) return std::nullopt;
        if (*projection != MapProjection::latlong) {
            const int height = latlong_height(picture.texels.size());
            picture.texels = resample_to_latlong(*projection, picture.width, picture.height,
                                                 picture.texels, height);
            picture.width = 2 * height, picture.height = height;
        }
        return make_environment(picture.width, picture.height, std::move(picture.texels),
                                color_of(desc.radiance), desc.rotate_deg, desc.visible);
    } catch (const Error& e) {
        if (e.code() == ExitCode::memory) throw;
        in.problems.error(desc.loc, fmt::format("environment: {}", e.what()));
        return std::nullopt;
    }
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
