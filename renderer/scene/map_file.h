#pragma once
// Pictures of all directions from disk.

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "renderer/api/scene_desc.h"
#include "renderer/image/colour_space.h"
#include "renderer/lights/reflection_map.h"

namespace tessera {

/// How to read them, and whom to name in messages ("environment").
struct MapFile {
    std::string subject;
    SourceLoc loc;
    EnvironmentMap projection = EnvironmentMap::automatic;
    std::string color_space;  // "" = linear working space
    Color scale{1.0f};
    double rotate_deg = 0;
};

/// One picture, or six faces +x -x +y -y +z -z as an observer inside sees them. Nothing after an
/// error, which is reported.
std::optional<LatLongMap> read_map(const MapFile& how, const std::string& file,
                                   const ColorSpaces& colors, Problems& problems);
std::optional<LatLongMap> read_faces(const MapFile& how, std::span<const std::string> files,
                                     const ColorSpaces& colors, Problems& problems);

/// The material must have one. origin: where the scene's own space lies in the world. Null after an
/// error.
std::shared_ptr<const ReflectionMap> make_reflection_map(const MaterialDesc& material, Vec3d origin,
                                                         const ColorSpaces& colors,
                                                         Problems& problems);

}  // namespace tessera
