#include "renderer/lights/reflection_map.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// Way along d from p (relative to the centre) to the sphere's far wall; negative: none ahead.
float to_sphere(Vec3f p, Vec3f d, float radius) {
    const float b = dot(p, d), c = length2(p) - radius * radius;
    const float root = b * b - c;
    return root >= 0.0f ? std::sqrt(root) - b : -1.0f;
}

// The nearest of the three walls that d leaves through.
float to_box(Vec3f p, Vec3f d, Vec3f lo, Vec3f hi) {
    float way = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0.0f) continue;
        const float wall = d[axis] > 0.0f ? hi[axis] : lo[axis];
        way = std::min(way, (wall - p[axis]) / d[axis]);
    }
    return way;
}

}  // namespace

void ReflectionMap::show_sphere(Vec3f position, float radius) noexcept {
    walls_ = Walls::sphere;
    position_ = position;
    radius_ = radius;
}

void ReflectionMap::show_box(Vec3f position, Vec3f lo, Vec3f hi) noexcept {
    walls_ = Walls::box;
    position_ = position;
    lo_ = lo;
    hi_ = hi;
}

// Lagarde & Zanuttini, "Local Image-Based Lighting with Parallax-Corrected Cubemaps", SIGGRAPH
// Talks 2012: the way from where the map was taken to where the ray meets its walls.
Vec3f ReflectionMap::corrected(Vec3f p, Vec3f d) const noexcept {
    if (walls_ == Walls::none) return d;
    const float way =
        walls_ == Walls::sphere ? to_sphere(p - position_, d, radius_) : to_box(p, d, lo_, hi_);
    if (!(way > 0.0f && way < kInfinity)) return d;
    const Vec3f to = p + d * way - position_;
    const float distance = length(to);
    return distance > 0.0f ? to / distance : d;
}

}  // namespace tessera
