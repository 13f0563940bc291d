#include "renderer/scene/map_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "renderer/image/image_io.h"
#include "renderer/lights/map_projection.h"
#include "renderer/lights/map_resample.h"

namespace tessera {
namespace {

struct Picture {
    int width = 0, height = 0;
    std::vector<Color> texels;  // in the working space
};

// Texels of the result are about as large as those of the source.
int latlong_height(std::size_t texels) {
    return std::clamp(static_cast<int>(std::sqrt(static_cast<double>(texels) / 2)), 16, 8192);
}

MapProjection projection_of(EnvironmentMap map) {
    return static_cast<MapProjection>(static_cast<int>(map) - 1);
}
static_assert(static_cast<int>(EnvironmentMap::angular) - 1 ==
              static_cast<int>(MapProjection::angular));

class MapReader {
public:
    MapReader(const MapFile& how, const ColorSpaces& colors, Problems& problems)
        : how_(how), colors_(colors), problems_(problems) {}

    std::optional<LatLongMap> map(const std::string& file) const {
        return reported([&] { return from_picture(file); });
    }
    std::optional<LatLongMap> faces(std::span<const std::string> files) const {
        return reported([&] { return from_faces(files); });
    }

private:
    template <class Read>
    std::optional<LatLongMap> reported(Read read) const {
        try {
            return read();
        } catch (const Error& e) {
            if (e.code() == ExitCode::memory) throw;
            problems_.error(how_.loc, fmt::format("{}: {}", how_.subject, e.what()));
            return std::nullopt;
        }
    }

    // Texels that are not finite or negative are taken as 0, with a warning.
    Picture read_picture(const std::string& file) const {
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
            problems_.warn(how_.loc,
                           fmt::format("{} '{}': {} texels are not finite or negative, taken as 0",
                                       how_.subject, file, bad));
        const bool eight_bit = !image_info(file).is_float;
        static_assert(sizeof(Color) == 3 * sizeof(float));
        colors_.to_working(
            {&out.texels[0].x, out.texels.size() * 3},
            how_.color_space.empty() && eight_bit ? "srgb_texture" : how_.color_space);
        for (Color& c : out.texels) c = is_finite(c) ? max(c, Color(0.0f)) : Color(0.0f);
        return out;
    }

    // What the picture is; nothing, reported, if that cannot be told. Shapes of no map are latlong,
    // as cropped ones are met.
    std::optional<MapProjection> find_projection(const std::string& file,
                                                 const Picture& picture) const {
        const int w = picture.width, h = picture.height;
        if (how_.projection != EnvironmentMap::automatic) {
            const MapProjection p = projection_of(how_.projection);
            if (p == MapProjection::latlong || projection_fits(p, w, h)) return p;
            problems_.error(how_.loc,
                            fmt::format("{} '{}': {}x{} pixels are not the shape of its projection",
                                        how_.subject, file, w, h));
            return std::nullopt;
        }
        const auto guesses = guess_projection(w, h);
        if (guesses.size() == 1) return guesses[0];
        if (guesses.size() == 2 && w > 1) {
            problems_.error(
                how_.loc,
                fmt::format("{} '{}': a square picture can be a mirror ball or an angular map; say "
                            "projection = \"mirror_ball\" or \"angular\" (or \"latlong\")",
                            how_.subject, file));
            return std::nullopt;
        }
        return MapProjection::latlong;
    }

    LatLongMap made(int width, int height, std::vector<Color> texels) const {
        return make_latlong_map(width, height, std::move(texels), how_.scale, how_.rotate_deg);
    }

    std::optional<LatLongMap> from_picture(const std::string& file) const {
        Picture picture = read_picture(file);
        const auto projection = find_projection(file, picture);
        if (!projection) return std::nullopt;
        if (*projection == MapProjection::latlong)
            return made(picture.width, picture.height, std::move(picture.texels));
        const int height = latlong_height(picture.texels.size());
        return made(2 * height, height,
                    resample_to_latlong(*projection, picture.width, picture.height, picture.texels,
                                        height));
    }

    std::optional<LatLongMap> from_faces(std::span<const std::string> files) const {
        std::array<Picture, 6> faces;
        std::array<std::span<const Color>, 6> spans;
        for (std::size_t i = 0; i < 6; ++i) {
            faces[i] = read_picture(files[i]);
            spans[i] = faces[i].texels;
            if (faces[i].width == faces[0].width && faces[i].height == faces[0].width) continue;
            problems_.error(how_.loc, fmt::format("{} '{}': faces are squares of one size",
                                                  how_.subject, files[i]));
            return std::nullopt;
        }
        const int size = faces[0].width;
        const int height = latlong_height(std::size_t(size) * std::size_t(size) * 6);
        return made(2 * height, height,
                    resample_to_latlong(CubeFaces::observer, size, spans, height));
    }

    const MapFile& how_;
    const ColorSpaces& colors_;
    Problems& problems_;
};

}  // namespace

std::optional<LatLongMap> read_map(const MapFile& how, const std::string& file,
                                   const ColorSpaces& colors, Problems& problems) {
    return MapReader(how, colors, problems).map(file);
}

std::optional<LatLongMap> read_faces(const MapFile& how, std::span<const std::string> files,
                                     const ColorSpaces& colors, Problems& problems) {
    return MapReader(how, colors, problems).faces(files);
}

std::shared_ptr<const ReflectionMap> make_reflection_map(const MaterialDesc& material, Vec3d origin,
                                                         const ColorSpaces& colors,
                                                         Problems& problems) {
    const ReflectionMapDesc& desc = *material.reflection_map;
    const MapFile how{fmt::format("material '{}': reflection_map: file", material.name),
                      desc.loc,
                      desc.projection,
                      desc.color_space,
                      Color(static_cast<float>(desc.scale)),
                      desc.rotate_deg};
    auto read = read_map(how, desc.file, colors, problems);
    if (!read) return nullptr;
    auto map = std::make_shared<ReflectionMap>(std::move(*read));
    const auto point = [&](const Double3& p) { return Vec3f(Vec3d(p) - origin); };
    if (desc.radius > 0)
        map->show_sphere(point(desc.position), static_cast<float>(desc.radius));
    else if (desc.box)
        map->show_box(point(desc.position), point((*desc.box)[0]), point((*desc.box)[1]));
    return map;
}

}  // namespace tessera
