#pragma once
// Any picture of all directions as a lat-long map, with the light it holds kept to the last lamp.

#include <array>
#include <span>
#include <vector>

#include "renderer/lights/map_projection.h"

namespace tessera {

/// A lat-long map, 2 height x height, rows from the top, of a picture in another projection (or
/// another size). Bilinear and seamless; each channel's integral over the sphere is that of the
/// picture (texels times their solid angles), and a texel far above the mean brings its own share
/// exactly, so that a sun of one texel neither gains nor dims the sky. Texels that are not finite
/// count as black. Empty if the picture does not fit the projection or its span is too short.
std::vector<Color> resample_to_latlong(MapProjection projection, int width, int height,
                                       std::span<const Color> picture, int latlong_height);

/// The same of six square faces of one size, +x -x +y -y +z -z.
std::vector<Color> resample_to_latlong(CubeFaces faces, int size,
                                       const std::array<std::span<const Color>, 6>& pictures,
                                       int latlong_height);

}  // namespace tessera
