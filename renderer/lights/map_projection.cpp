#include "renderer/lights/map_projection.h"

#include <cmath>

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;

constexpr FaceFrame kOpenGl[6] = {
    {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}},
};

constexpr FaceFrame kObserver[6] = {
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},  {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},  {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
    {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}, {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}},
};

constexpr CubeLayout kHorizontal{CubeFaces::observer,
                                 4,
                                 3,
                                 {{{0, 2, 1, false},
                                   {1, 0, 1, false},
                                   {2, 1, 0, false},
                                   {3, 1, 2, false},
                                   {4, 3, 1, false},
                                   {5, 1, 1, false}}}};
constexpr CubeLayout kVertical{CubeFaces::observer,
                               3,
                               4,
                               {{{0, 2, 1, false},
                                 {1, 0, 1, false},
                                 {2, 1, 0, false},
                                 {3, 1, 2, false},
                                 {4, 1, 3, true},
                                 {5, 1, 1, false}}}};
constexpr CubeLayout kStrip{CubeFaces::opengl,
                            6,
                            1,
                            {{{0, 0, 0, false},
                              {1, 1, 0, false},
                              {2, 2, 0, false},
                              {3, 3, 0, false},
                              {4, 4, 0, false},
                              {5, 5, 0, false}}}};

MapPoint turn(MapPoint p, bool turned) { return turned ? MapPoint{1 - p.x, 1 - p.y} : p; }

MapPoint latlong_point(Vec3d d) {
    return {0.5 + std::atan2(d.x, -d.z) / (2 * kPiD), std::atan2(std::hypot(d.x, d.z), d.y) / kPiD};
}

Vec3d latlong_to_direction(MapPoint p) {
    const double phi = 2 * kPiD * (p.x - 0.5), theta = kPiD * p.y;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

MapPoint cube_point(const CubeLayout& layout, Vec3d d) {
    const FacePoint f = face_point(layout.faces, d);
    const CubeCell& cell = layout.cells[static_cast<std::size_t>(f.face)];
    const MapPoint p = turn(f.p, cell.turned);
    // Not upon the far edges: they are the next cell's, which may be no neighbour or empty.
    constexpr double kMost = 1 - 1e-12;
    return {(cell.column + std::min(p.x, kMost)) / layout.columns,
            (cell.row + std::min(p.y, kMost)) / layout.rows};
}

std::optional<Vec3d> cube_to_direction(const CubeLayout& layout, MapPoint p) {
    const double x = p.x * layout.columns, y = p.y * layout.rows;
    const int column = std::min(static_cast<int>(x), layout.columns - 1),
              row = std::min(static_cast<int>(y), layout.rows - 1);
    for (const CubeCell& cell : layout.cells) {
        if (cell.column == column && cell.row == row)
            return face_direction(layout.faces, cell.face,
                                  turn({x - column, y - row}, cell.turned));
    }
    return std::nullopt;
}

// The disc's point at radius r toward (x, y), y up.
MapPoint disc_point(double x, double y, double r) {
    const double l = std::hypot(x, y);
    const double cos = l > 0 ? x / l : 1, sin = l > 0 ? y / l : 0;
    return {0.5 + 0.5 * r * cos, 0.5 - 0.5 * r * sin};
}

// Half the angle between d and +z decides where a sphere reflects toward +z: the normal lies
// between the two, r is its sine.
MapPoint ball_point(Vec3d d) {
    const double across = std::hypot(d.x, d.y);
    return disc_point(d.x, d.y, std::sin(0.5 * std::atan2(across, d.z)));
}

std::optional<Vec3d> ball_to_direction(double x, double y) {
    const double r2 = x * x + y * y;
    if (r2 > 1) return std::nullopt;
    const double z = std::sqrt(1 - r2);
    return Vec3d{2 * z * x, 2 * z * y, 1 - 2 * r2};
}

MapPoint angular_point(Vec3d d) {
    return disc_point(d.x, d.y, std::atan2(std::hypot(d.x, d.y), -d.z) / kPiD);
}

std::optional<Vec3d> angular_to_direction(double x, double y) {
    const double r = std::hypot(x, y);
    if (r > 1) return std::nullopt;
    const double s = r > 0 ? std::sin(kPiD * r) / r : 0;
    return Vec3d{s * x, s * y, -std::cos(kPiD * r)};
}

}  // namespace

const CubeLayout* cube_layout(MapProjection projection) noexcept {
    switch (projection) {
        case MapProjection::cube_cross_horizontal:
            return &kHorizontal;
        case MapProjection::cube_cross_vertical:
            return &kVertical;
        case MapProjection::cube_strip:
            return &kStrip;
        default:
            return nullptr;
    }
}

const FaceFrame& face_frame(CubeFaces faces, int face) noexcept {
    return (faces == CubeFaces::opengl ? kOpenGl : kObserver)[face];
}

FacePoint face_point(CubeFaces faces, Vec3d d) {
    const Vec3d a = abs(d);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : (a.y >= a.z ? 1 : 2);
    const int face = 2 * axis + (d[axis] < 0 ? 1 : 0);
    const FaceFrame& f = face_frame(faces, face);
    const double far = a[axis];
    return {face, {0.5 + 0.5 * dot(d, f.right) / far, 0.5 + 0.5 * dot(d, f.down) / far}};
}

Vec3d face_direction(CubeFaces faces, int face, MapPoint p) {
    const FaceFrame& f = face_frame(faces, face);
    return normalize(f.forward + f.right * (2 * p.x - 1) + f.down * (2 * p.y - 1));
}

MapPoint map_point(MapProjection projection, Vec3d d) {
    switch (projection) {
        case MapProjection::mirror_ball:
            return ball_point(d);
        case MapProjection::angular:
            return angular_point(d);
        case MapProjection::latlong:
            return latlong_point(d);
        default:
            return cube_point(*cube_layout(projection), d);
    }
}

std::optional<Vec3d> map_direction(MapProjection projection, MapPoint p) {
    if (!(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1)) return std::nullopt;
    switch (projection) {
        case MapProjection::mirror_ball:
            return ball_to_direction(2 * p.x - 1, 1 - 2 * p.y);
        case MapProjection::angular:
            return angular_to_direction(2 * p.x - 1, 1 - 2 * p.y);
        case MapProjection::latlong:
            return latlong_to_direction(p);
        default:
            return cube_to_direction(*cube_layout(projection), p);
    }
}

bool projection_fits(MapProjection projection, int width, int height) noexcept {
    if (width <= 0 || height <= 0) return false;
    if (projection == MapProjection::latlong) return true;
    const CubeLayout* cube = cube_layout(projection);
    if (!cube) return width == height;
    const int cell = width / cube->columns;
    return cell * cube->columns == width && height % cube->rows == 0 && height / cube->rows == cell;
}

std::span<const MapProjection> guess_projection(int width, int height) noexcept {
    static constexpr MapProjection kAll[] = {MapProjection::latlong,
                                             MapProjection::cube_cross_horizontal,
                                             MapProjection::cube_cross_vertical,
                                             MapProjection::cube_strip,
                                             MapProjection::mirror_ball,
                                             MapProjection::angular};
    const std::span all(kAll);
    if (width > 0 && height > 0 && std::int64_t{2} * height == width) return all.subspan(0, 1);
    for (std::size_t cube = 1; cube < 4; ++cube) {
        if (projection_fits(kAll[cube], width, height)) return all.subspan(cube, 1);
    }
    return width > 0 && width == height ? all.subspan(4, 2) : all.subspan(0, 0);
}

}  // namespace tessera
