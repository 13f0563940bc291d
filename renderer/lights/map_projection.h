#pragma once
// How pictures hold all directions around a point, and which one a picture's size suggests.
// Directions are unit vectors, y up. (u, v) runs over [0,1]^2 from the picture's top left corner.
// latlong            u = 0.5 looks along -z, u grows toward +x; v = 0 is +y.
// cube_cross_*       the cube unfolded as seen from inside, -z in the middle, +x to its right; the
//                    vertical cross has +z at the bottom, upside down.
// cube_strip         +x -x +y -y +z -z side by side, each as OpenGL takes it.
// mirror_ball        a mirrored sphere photographed by an orthographic camera that looks along -z:
//                    the centre shows +z (the camera), the rim -z. Debevec, "Rendering Synthetic
//                    Objects into Real Scenes", SIGGRAPH 1998.
// angular            the angle from -z grows in proportion to the radius: the centre shows -z, the
//                    rim +z. Debevec, "Light Probe Image Gallery", 1998.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "renderer/core/fast_math.h"
#include "renderer/core/vec.h"

namespace tessera {

enum class MapProjection : std::uint8_t {
    latlong,
    cube_cross_horizontal,
    cube_cross_vertical,
    cube_strip,
    mirror_ball,
    angular,
};

/// In double: the rim of a mirror ball loses half of all digits.
using MapPoint = Vec2<double>;

/// Where a picture shows the direction d. A rim that shows one direction all round: its right end.
MapPoint map_point(MapProjection projection, Vec3d d);

/// The direction shown at a point; none beyond the picture, off a cross or off a disc.
std::optional<Vec3d> map_direction(MapProjection projection, MapPoint p);

/// Six single faces, numbered +x -x +y -y +z -z by the direction in their middle.
enum class CubeFaces : std::uint8_t {
    /// OpenGL 4.2 (compatibility), table 3.23, first row on top: the pictures are mirror images in
    /// our
    /// right-handed frame, as they are in OpenGL's.
    opengl,
    /// What an observer inside sees, up being +y; +y and -y are joined to -z. The cells of the
    /// horizontal cross.
    observer,
};

/// Unit vectors to a face's middle, and along its rows and columns.
struct FaceFrame {
    Vec3d forward, right, down;
};
const FaceFrame& face_frame(CubeFaces faces, int face) noexcept;

struct FacePoint {
    int face = 0;
    MapPoint p;
};

FacePoint face_point(CubeFaces faces, Vec3d d);
Vec3d face_direction(CubeFaces faces, int face, MapPoint p);

/// A cube's face as it lies in a picture that is columns x rows such cells.
struct CubeCell {
    int face, column, row;
    bool turned;  // by half a turn
};
struct CubeLayout {
    CubeFaces faces;
    int columns, rows;
    std::array<CubeCell, 6> cells;  // in the order of the faces
};
/// nullptr for what is no cube.
const CubeLayout* cube_layout(MapProjection projection) noexcept;

/// Whether a picture of this size can be such a map; discs must be square, cells too.
bool projection_fits(MapProjection projection, int width, int height) noexcept;

/// What the size suggests: 2:1 latlong, 4:3 and 3:4 a cross, 6:1 a strip. A square is ambiguous,
/// and both are returned: mirror_ball, angular. Empty: no map that we know.
std::span<const MapProjection> guess_projection(int width, int height) noexcept;

/// map_direction for cameras: latlong, in float and without a branch.
inline Vec3f latlong_direction(Vec2f uv) {
    const SinCos phi = sincos_turn(uv.x), theta = sincos_turn(0.5f * uv.y);
    return {-theta.sin * phi.sin, theta.cos, theta.sin * phi.cos};
}

}  // namespace tessera
