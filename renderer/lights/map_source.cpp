#include "renderer/lights/map_source.h"

#include <cmath>

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;

Color or_black(Color c) { return is_finite(c) ? c : Color(0.0f); }

// Solid angle of a face's part from its middle to (x, y), the face at distance 1: the integral of
// (1 + x^2 + y^2)^(-3/2).
double corner_solid_angle(double x, double y) {
    return std::atan2(x * y, std::sqrt(x * x + y * y + 1));
}

void scale_to_sphere(std::vector<double>& solid_angles) {
    double sum = 0;
    for (double s : solid_angles) sum += s;
    if (!(sum > 0)) return;
    for (double& s : solid_angles) s *= 4 * kPiD / sum;
}

MapSource::Taps normalized(MapSource::Taps taps) {
    double sum = 0;
    for (const auto& t : taps) sum += t.weight;
    for (auto& t : taps) t.weight /= sum;
    return taps;
}

// The four texels around a point: the first of them, and how far the point is from its middle.
struct Cell {
    int x, y;
    double tx, ty;
    Cell(MapPoint p, int width, int height) {
        tx = p.x * width - 0.5, ty = p.y * height - 0.5;
        x = static_cast<int>(std::floor(tx)), y = static_cast<int>(std::floor(ty));
        tx -= x, ty -= y;
    }
    double weight(int k) const { return (k & 1 ? tx : 1 - tx) * (k >> 1 ? ty : 1 - ty); }
};

}  // namespace

MapSource::MapSource(MapProjection projection, int width, int height,
                     std::span<const Color> picture)
    : projection_(projection), width_(width), height_(height) {
    texels_.resize(picture.size());
    const CubeLayout* layout = cube_layout(projection);
    if (!layout) {
        for (std::size_t i = 0; i < picture.size(); ++i) texels_[i] = or_black(picture[i]);
        weigh_flat();
        return;
    }
    cube_ = true;
    faces_ = layout->faces;
    const int n = width / layout->columns;
    width_ = height_ = n;
    texels_.resize(std::size_t{6} * n * n);
    for (const CubeCell& cell : layout->cells) {
        for (int i = 0; i < n * n; ++i) {
            const int from = cell.turned ? n * n - 1 - i : i;
            const int x = cell.column * n + from % n, y = cell.row * n + from / n;
            texels_[std::size_t(cell.face) * n * n + i] =
                or_black(picture[std::size_t(y) * width + x]);
        }
    }
    weigh_cube();
}

MapSource::MapSource(CubeFaces faces, int size,
                     const std::array<std::span<const Color>, 6>& pictures)
    : projection_(MapProjection::cube_strip),
      cube_(true),
      faces_(faces),
      width_(size),
      height_(size) {
    for (const auto& face : pictures) {
        for (Color c : face) texels_.push_back(or_black(c));
    }
    weigh_cube();
}

void MapSource::weigh_cube() {
    const int n = width_;
    for (int i = 0; i < 6 * n * n; ++i) {
        const double x0 = 2.0 * (i % n) / n - 1, x1 = x0 + 2.0 / n;
        const double y0 = 2.0 * (i / n % n) / n - 1, y1 = y0 + 2.0 / n;
        solid_angles_.push_back(corner_solid_angle(x1, y1) - corner_solid_angle(x0, y1) -
                                corner_solid_angle(x1, y0) + corner_solid_angle(x0, y0));
    }
    scale_to_sphere(solid_angles_);
}

void MapSource::weigh_flat() {
    for (int y = 0; y < height_; ++y) {
        // A row's share is cos - cos of its edges, which is in proportion to the sine between.
        const double row = std::sin(kPiD * (y + 0.5) / height_);
        for (int x = 0; x < width_; ++x) {
            double weight = row;
            if (projection_ != MapProjection::latlong) {
                const double r =
                    std::hypot(2 * (x + 0.5) / width_ - 1, 2 * (y + 0.5) / height_ - 1);
                // A mirror ball keeps areas; an angular map crowds them at its rim.
                weight = r >= 1 ? 0
                         : projection_ == MapProjection::mirror_ball || r == 0
                             ? 1
                             : std::sin(kPiD * r) / (kPiD * r);
            }
            solid_angles_.push_back(weight);
        }
    }
    scale_to_sphere(solid_angles_);
}

MapSource::Taps MapSource::taps(Vec3d d) const {
    if (cube_) return cube_taps(d);
    return projection_ == MapProjection::latlong ? latlong_taps(d) : disc_taps(d);
}

MapSource::Taps MapSource::latlong_taps(Vec3d d) const {
    const Cell cell(map_point(projection_, d), width_, height_);
    Taps taps;
    for (int k = 0; k < 4; ++k) {
        int x = cell.x + (k & 1);
        const int y = cell.y + (k >> 1);
        // Over the pole one comes down on the other side.
        if (y < 0 || y >= height_) x += width_ / 2;
        x = (x % width_ + width_) % width_;
        taps[static_cast<std::size_t>(k)] = {
            std::size_t(std::clamp(y, 0, height_ - 1)) * width_ + x, cell.weight(k)};
    }
    return taps;
}

MapSource::Taps MapSource::disc_taps(Vec3d d) const {
    MapPoint p = map_point(projection_, d);
    // At the rim all four may lie without; a texel further inward one does not.
    for (const double inward : {1.0, 1 - 2.0 / width_}) {
        p = {0.5 + inward * (p.x - 0.5), 0.5 + inward * (p.y - 0.5)};
        const Cell cell(p, width_, height_);
        Taps taps;
        double sum = 0;
        for (int k = 0; k < 4; ++k) {
            const int x = std::clamp(cell.x + (k & 1), 0, width_ - 1),
                      y = std::clamp(cell.y + (k >> 1), 0, height_ - 1);
            const std::size_t texel = std::size_t(y) * width_ + x;
            const double weight = solid_angles_[texel] > 0 ? cell.weight(k) : 0;
            taps[static_cast<std::size_t>(k)] = {texel, weight};
            sum += weight;
        }
        if (sum > 1e-9) return normalized(taps);
    }
    return {};
}

MapSource::Taps MapSource::cube_taps(Vec3d d) const {
    const int n = width_;
    const FacePoint f = face_point(faces_, d);
    const Cell cell(f.p, n, n);
    Taps taps;
    for (int k = 0; k < 4; ++k) {
        const int x = cell.x + (k & 1), y = cell.y + (k >> 1);
        const bool beside = x < 0 || x >= n, above = y < 0 || y >= n;
        // Three faces meet at a corner: the fourth texel does not exist.
        taps[static_cast<std::size_t>(k)] = {
            beside && above ? 0 : face_texel(f.face, x, y),
            beside && above ? 0 : cell.weight(k),
        };
    }
    return normalized(taps);
}

std::size_t MapSource::face_texel(int face, int x, int y) const {
    const int n = width_;
    if (x < 0 || x >= n || y < 0 || y >= n) {
        // What reaches beyond the edge is folded down onto the adjoining face.
        const FaceFrame& f = face_frame(faces_, face);
        const double s = (2 * x + 1.0) / n - 1, t = (2 * y + 1.0) / n - 1;
        const FacePoint there =
            face_point(faces_, f.forward * (1 - 1.0 / n) + f.right * std::clamp(s, -1.0, 1.0) +
                                   f.down * std::clamp(t, -1.0, 1.0));
        face = there.face;
        x = std::clamp(static_cast<int>(there.p.x * n), 0, n - 1);
        y = std::clamp(static_cast<int>(there.p.y * n), 0, n - 1);
    }
    return (std::size_t(face) * n + y) * n + x;
}

Vec3d MapSource::direction(std::size_t i) const {
    const int per_face = width_ * height_;
    const int face = static_cast<int>(i / per_face), j = static_cast<int>(i % per_face);
    const int x = j % width_, y = j / width_;
    const MapPoint p{(x + 0.5) / width_, (y + 0.5) / height_};
    if (cube_) return face_direction(faces_, face, p);
    return map_direction(projection_, p).value_or(Vec3d{0, 0, 1});
}

Vec3d MapSource::total() const {
    Vec3d sum;
    for (std::size_t i = 0; i < texels_.size(); ++i) sum += Vec3d(texels_[i]) * solid_angles_[i];
    return sum;
}

double MapSource::resolution() const {
    double covered = 0;
    for (double s : solid_angles_) covered += s > 0 ? 1 : 0;
    return std::sqrt(covered);
}

}  // namespace tessera
