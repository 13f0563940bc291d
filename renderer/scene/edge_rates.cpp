#include "renderer/scene/edge_rates.h"

#include <algorithm>
#include <cmath>

#include "renderer/geometry/dice.h"

namespace tessera {
namespace {

struct Ball {
    Vec3d center;
    double radius = 0;
};

Ball ball_of(const Cage& cage) {
    double r2 = 0;
    for (const std::uint32_t p : cage.place) r2 = std::max(r2, length2(Vec3d(cage.places[p])));
    return {cage.origin, std::sqrt(r2)};
}

double distance_to_segment(Vec3d p, Vec3d a, Vec3d b) {
    const Vec3d ab = b - a;
    const double l2 = length2(ab);
    const double t = l2 > 0 ? std::clamp(dot(p - a, ab) / l2, 0.0, 1.0) : 0;
    return length(a + ab * t - p);
}

}  // namespace

double ViewScale::pixels(double length, double distance) const {
    return length * per_unit / (parallel ? 1.0 : std::max(distance, 1e-300));
}

ViewScale view_scale(const Camera& camera, Vec3d origin) {
    ViewScale v;
    v.eye = Vec3d(camera.position()) + origin;
    v.parallel = camera.cone_spread() == 0.0f;
    const double pixel =
        static_cast<double>(v.parallel ? camera.cone_width() : camera.cone_spread());
    v.per_unit = 1.0 / pixel;
    return v;
}

const Affined& nearest_placement(const Cage& cage, std::span<const Affined> placements,
                                 const ViewScale& view) {
    const Ball ball = ball_of(cage);
    const Affined* nearest = &placements.front();
    double largest = -1;
    for (const Affined& m : placements) {
        const double scale = std::cbrt(std::abs(m.determinant())), r = ball.radius * scale;
        const double distance = length(m.point(ball.center) - view.eye) - r;
        const double pixels = view.pixels(scale, std::max(distance, 1e-3 * r));
        if (pixels > largest) largest = pixels, nearest = &m;
    }
    return *nearest;
}

EdgeRates edge_rates(const Cage& cage, const SubdivisionDesc& desc, double unit,
                     const Affined& placement, const ViewScale& view) {
    EdgeRates out;
    out.rates.reserve(cage.edges.size());
    for (const Cage::Edge& edge : cage.edges) {
        double pieces = desc.rate;
        if (desc.rate == 0) {
            const Vec3d a = Vec3d(cage.places[edge.a]), b = Vec3d(cage.places[edge.b]);
            if (desc.edge_length > 0) {
                pieces = length(b - a) * unit / desc.edge_length;
            } else {
                const Vec3d p = placement.point(a + cage.origin),
                            q = placement.point(b + cage.origin);
                pieces = view.pixels(length(q - p), distance_to_segment(view.eye, p, q)) /
                         desc.edge_length_px;
            }
            // A little above a whole number is that number.
            pieces = std::ceil(pieces - 1e-6);
        }
        out.limited += pieces > desc.max_rate;
        out.rates.push_back(static_cast<int>(std::clamp<double>(pieces, 1, desc.max_rate)));
    }
    make_even(cage, out.rates);
    return out;
}

}  // namespace tessera
