#pragma once
// What a surface mirrors in place of the scene around it: a picture of all directions, taken near
// by. Blinn & Newell, "Texture and Reflection in Computer Generated Images", CACM 19(10), 1976.

#include "renderer/lights/latlong_map.h"

namespace tessera {

/// Positions in the scene's own space.
class ReflectionMap {
public:
    /// Everything that it shows is infinitely far.
    explicit ReflectionMap(LatLongMap map) noexcept : map_(std::move(map)) {}

    /// It shows the walls of a sphere or a box as seen from `position`.
    void show_sphere(Vec3f position, float radius) noexcept;
    void show_box(Vec3f position, Vec3f lo, Vec3f hi) noexcept;

    /// Light that arrives at p from the direction d, of unit length. Beyond the walls, where the
    /// ray meets none, as if they were infinitely far.
    Color seen(Vec3f p, Vec3f d) const noexcept { return map_.look(corrected(p, d)); }
    std::size_t bytes() const noexcept { return map_.bytes(); }

private:
    enum class Walls { none, sphere, box };
    Vec3f corrected(Vec3f p, Vec3f d) const noexcept;

    LatLongMap map_;
    Walls walls_ = Walls::none;
    Vec3f position_, lo_, hi_;
    float radius_ = 0;
};

}  // namespace tessera
