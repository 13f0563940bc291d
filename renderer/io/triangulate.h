#pragma once
// Polygons in space to triangles and quads. Corners are numbered as given; orientation is kept.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/core/vec.h"

namespace tessera {

/// Twice the vector area (Newell): the direction is the face's normal.
Vec3d newell(std::span<const Vec3d> polygon) noexcept;

/// Whether a triangle has no area to speak of (relative to its longest edge).
bool is_degenerate(Vec3d a, Vec3d b, Vec3d c) noexcept;

/// What becomes of a face with four corners. The tracer splits a quad along corners 1-3 of its
/// order.
struct QuadShape {
    bool is_quad = false;  // else triangles
    std::array<std::uint8_t, 4> quad{};
    int triangles = 0;  // 0..2; 0 and no quad: degenerate
    std::array<std::array<std::uint8_t, 3>, 2> triangle{};
};
QuadShape shape_quad(std::span<const Vec3d, 4> corners) noexcept;

/// Ear clipping in the plane of the Newell normal. Concave outlines, keyholes (holes joined by a
/// bridge that is walked twice), collinear and repeated points are right; outlines that cross
/// themselves give some triangulation. Keeps its memory between calls.
class Triangulator {
public:
    using Triangle = std::array<std::uint32_t, 3>;

    /// Triangles as corner numbers; none for a polygon without area. Valid until the next call.
    const std::vector<Triangle>& run(std::span<const Vec3d> polygon);

    /// Whether the last polygon needed the fan that ends a search grown too long (about 1000 tests
    /// a corner).
    bool fell_back() const noexcept { return fell_back_; }

private:
    struct Point {
        double x, y;
    };
    bool project(std::span<const Vec3d> polygon);
    void build_grid();
    double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const noexcept;
    bool is_reflex(std::uint32_t i) const noexcept;
    bool is_ear(std::uint32_t i, bool touching_blocks);
    bool blocks(std::uint32_t p, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                bool touching_blocks) const noexcept;
    bool same(std::uint32_t a, std::uint32_t b) const noexcept;
    int cell(double value, double low) const noexcept;
    void clip(std::uint32_t i);
    void fan(std::uint32_t first);

    std::vector<Point> points_;
    std::vector<std::uint32_t> next_, previous_;
    std::vector<std::uint32_t> cell_begin_,
        cell_points_;  // reflex corners, bucketed over the outline
    std::vector<Triangle> triangles_;
    Point low_{}, high_{};
    double per_cell_ = 0;
    double epsilon_ = 0;  // a turn below it is straight
    int grid_ = 1;
    std::int64_t budget_ = 0;
    bool fell_back_ = false;
};

}  // namespace tessera
