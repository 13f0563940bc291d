#include "renderer/io/triangulate.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Below this share of the longest edge squared, twice the area is rounding.
constexpr double kFlat = 1e-14;
// Two halves of a quad whose normals differ by more than about 5 degrees are not one flat face.
constexpr double kPlanarCos = 0.996;

Vec3d area2(Vec3d a, Vec3d b, Vec3d c) noexcept { return cross(b - a, c - a); }

}  // namespace

Vec3d newell(std::span<const Vec3d> polygon) noexcept {
    Vec3d sum;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += area2(polygon[0], polygon[i], polygon[i + 1]);
    return sum;
}

bool is_degenerate(Vec3d a, Vec3d b, Vec3d c) noexcept {
    const double longest = std::max({length2(b - a), length2(c - b), length2(a - c)});
    return !(length(area2(a, b, c)) > kFlat * longest);
}

QuadShape shape_quad(std::span<const Vec3d, 4> p) noexcept {
    constexpr std::array<std::array<std::uint8_t, 3>, 4> kHalf{
        {{0, 1, 3}, {2, 3, 1}, {0, 1, 2}, {2, 3, 0}}};
    const Vec3d normal = newell(p);
    std::array<Vec3d, 4> half;
    std::array<bool, 4> flat;
    std::array<bool, 4> inside;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& t = kHalf[i];
        half[i] = area2(p[t[0]], p[t[1]], p[t[2]]);
        flat[i] = is_degenerate(p[t[0]], p[t[1]], p[t[2]]);
        inside[i] = !flat[i] && dot(half[i], normal) > 0;
    }
    const bool by_13 = inside[0] && inside[1];
    const bool by_02 = inside[2] && inside[3];
    const auto is_planar = [&](std::size_t i) {
        return dot(half[i], half[i + 1]) >= kPlanarCos * length(half[i]) * length(half[i + 1]);
    };
    QuadShape out;
    if (by_13 && is_planar(0)) {
        out.is_quad = true;
        out.quad = {0, 1, 2, 3};
        return out;
    }
    if (by_02 && is_planar(2)) {
        out.is_quad = true;
        out.quad = {1, 2, 3, 0};
        return out;
    }
    const bool shorter_13 = length2(p[3] - p[1]) < length2(p[2] - p[0]);
    const bool use_13 = by_13 == by_02 ? shorter_13 : by_13;
    for (std::size_t i = use_13 ? 0 : 2, end = i + 2; i < end; ++i)
        if (!flat[i]) out.triangle[static_cast<std::size_t>(out.triangles++)] = kHalf[i];
    return out;
}

const std::vector<Triangulator::Triangle>& Triangulator::run(std::span<const Vec3d> polygon) {
    triangles_.clear();
    fell_back_ = false;
    if (polygon.size() < 3 || !project(polygon)) return triangles_;
    const auto n = static_cast<std::uint32_t>(polygon.size());
    next_.resize(n);
    previous_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        next_[i] = i + 1 < n ? i + 1 : 0;
        previous_[i] = i > 0 ? i - 1 : n - 1;
    }
    build_grid();
    budget_ = 1000 * std::int64_t(n) + 10000;

    // A round without an ear loosens the test: 0 touching corners block, 1 only inner ones do, 2
    // straight corners and spikes go, 3 whatever turns left, 4 fan.
    std::uint32_t at = 0;
    std::uint32_t left = n;
    std::uint32_t idle = 0;
    int looseness = 0;
    while (left > 3) {
        const std::uint32_t a = previous_[at];
        const std::uint32_t c = next_[at];
        const double corner = turn(a, at, c);
        const bool spike = same(a, c) || same(a, at) || same(at, c);
        bool ear = false;
        if (spike || (looseness >= 2 && std::abs(corner) <= epsilon_)) {
            clip(at);
            ear = true;
        } else if (corner > epsilon_ && (looseness >= 3 || is_ear(at, looseness == 0))) {
            triangles_.push_back({a, at, c});
            clip(at);
            ear = true;
        }
        if (ear) {
            --left;
            idle = 0;
            looseness = 0;
            at = next_[c];  // skipping one spreads the ears, which keeps triangles fatter
            continue;
        }
        at = c;
        if (++idle > left || budget_ < 0) {
            idle = 0;
            if (++looseness == 4 || budget_ < 0) {
                fan(at);
                return triangles_;
            }
        }
    }
    if (turn(previous_[at], at, next_[at]) > epsilon_)
        triangles_.push_back({previous_[at], at, next_[at]});
    return triangles_;
}

// Drops the outline into the plane of its normal, so that it turns left.
bool Triangulator::project(std::span<const Vec3d> polygon) {
    const Vec3d area = newell(polygon);
    double extent2 = 0;
    for (const Vec3d& p : polygon) extent2 = std::max(extent2, length2(p - polygon[0]));
    if (!(length(area) > kFlat * extent2)) return false;
    const Vec3d normal = normalize(area);
    const Vec3d axis = std::abs(normal.x) > 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
    const Vec3d u = normalize(cross(axis, normal));
    const Vec3d v = cross(normal, u);
    points_.resize(polygon.size());
    low_ = high_ = {0, 0};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3d d = polygon[i] - polygon[0];
        points_[i] = {dot(d, u), dot(d, v)};
        low_ = {std::min(low_.x, points_[i].x), std::min(low_.y, points_[i].y)};
        high_ = {std::max(high_.x, points_[i].x), std::max(high_.y, points_[i].y)};
    }
    epsilon_ = 1e-15 * extent2;
    return true;
}

void Triangulator::build_grid() {
    const auto n = static_cast<std::uint32_t>(points_.size());
    grid_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(n))), 1, 256);
    const double extent = std::max(high_.x - low_.x, high_.y - low_.y);
    per_cell_ = grid_ / extent;
    cell_begin_.assign(static_cast<std::size_t>(grid_) * grid_ + 1, 0);
    const auto cell_of = [&](std::uint32_t i) {
        return static_cast<std::size_t>(cell(points_[i].y, low_.y)) * grid_ +
               cell(points_[i].x, low_.x);
    };
    for (std::uint32_t i = 0; i < n; ++i)
        if (is_reflex(i)) ++cell_begin_[cell_of(i) + 1];
    for (std::size_t i = 1; i < cell_begin_.size(); ++i) cell_begin_[i] += cell_begin_[i - 1];
    cell_points_.resize(cell_begin_.back());
    std::vector<std::uint32_t> fill(cell_begin_.begin(), cell_begin_.end() - 1);
    for (std::uint32_t i = 0; i < n; ++i)
        if (is_reflex(i)) cell_points_[fill[cell_of(i)]++] = i;
}

double Triangulator::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const noexcept {
    const Point& p = points_[a];
    const Point& q = points_[b];
    const Point& r = points_[c];
    return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
}

bool Triangulator::is_reflex(std::uint32_t i) const noexcept {
    return turn(previous_[i], i, next_[i]) <= epsilon_;
}

bool Triangulator::same(std::uint32_t a, std::uint32_t b) const noexcept {
    return points_[a].x == points_[b].x && points_[a].y == points_[b].y;
}

int Triangulator::cell(double value, double low) const noexcept {
    return std::clamp(static_cast<int>((value - low) * per_cell_), 0, grid_ - 1);
}

bool Triangulator::is_ear(std::uint32_t i, bool touching_blocks) {
    const std::uint32_t a = previous_[i];
    const std::uint32_t c = next_[i];
    const auto [x0, x1] = std::minmax({points_[a].x, points_[i].x, points_[c].x});
    const auto [y0, y1] = std::minmax({points_[a].y, points_[i].y, points_[c].y});
    const int column0 = cell(x0, low_.x);
    const int column1 = cell(x1, low_.x);
    for (int row = cell(y0, low_.y), last = cell(y1, low_.y); row <= last; ++row) {
        const std::size_t first = static_cast<std::size_t>(row) * grid_;
        const std::uint32_t begin = cell_begin_[first + column0];
        const std::uint32_t end = cell_begin_[first + column1 + 1];
        budget_ -= end - begin + 1;
        for (std::uint32_t k = begin; k < end; ++k)
            if (blocks(cell_points_[k], a, i, c, touching_blocks)) return false;
    }
    return true;
}

bool Triangulator::blocks(std::uint32_t p, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                          bool touching_blocks) const noexcept {
    const double least = touching_blocks ? -epsilon_ : epsilon_;
    if (turn(a, b, p) < least || turn(b, c, p) < least || turn(c, a, p) < least) return false;
    // The other end of a keyhole's bridge lies on a corner of the ear and does not cut it.
    if (p == a || p == b || p == c || same(p, a) || same(p, b) || same(p, c)) return false;
    return next_[p] != p && is_reflex(p);  // a clipped corner points to itself
}

void Triangulator::clip(std::uint32_t i) {
    next_[previous_[i]] = next_[i];
    previous_[next_[i]] = previous_[i];
    next_[i] = previous_[i] = i;
}

void Triangulator::fan(std::uint32_t first) {
    fell_back_ = true;
    for (std::uint32_t i = next_[first]; next_[i] != first; i = next_[i])
        if (std::abs(turn(first, i, next_[i])) > epsilon_)
            triangles_.push_back({first, i, next_[i]});
}

}  // namespace tessera
