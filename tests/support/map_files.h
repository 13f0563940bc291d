#pragma once
// Pictures of all directions as files.

#include <string>

#include "renderer/api/image.h"
#include "renderer/core/vec.h"
#include "renderer/lights/map_projection.h"

namespace tessera {

/// A picture in 32-bit floats; f(direction) is what it shows, black where it shows nothing.
template <class F>
void write_map(const std::string& path, MapProjection projection, int width, int height,
               const F& f) {
    LayeredImage image;
    image.width = width, image.height = height;
    image.window = {0, 0, width, height};
    Layer layer{"", {"R", "G", "B"}, LayerKind::data, {}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const auto d = map_direction(projection, {(x + 0.5) / width, (y + 0.5) / height});
            const Color c = d ? f(*d) : Color(0.0f);
            layer.pixels.insert(layer.pixels.end(), {c.x, c.y, c.z});
        }
    }
    image.layers.push_back(std::move(layer));
    write_exr(image, path, {.all_float = true});
}

/// A constant lat-long map.
inline void write_map(const std::string& path, Color c) {
    write_map(path, MapProjection::latlong, 8, 4, [&](Vec3d) { return c; });
}

/// No direction looks like another, and there is a bright spot to be found by light sampling.
inline Color lively(Vec3d d) {
    const Vec3d spot = normalize(Vec3d{0.6, 0.5, 0.62});
    const double hot = 40 * std::exp(60 * (dot(d, spot) - 1));
    return Color(Vec3f(Vec3d{0.6 + 0.5 * d.x, 0.6 + 0.5 * d.y, 0.6 + 0.5 * d.z} + Vec3d(hot)));
}

}  // namespace tessera
