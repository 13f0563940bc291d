#pragma once
// Uniform sampling of the solid angle of a rectangle.
// Urena, Fajardo, King, "An Area-Preserving Parametrization for Spherical Rectangles", EGSR 2013.

#include "renderer/core/vec.h"

namespace tessera {

struct SphericalRectangle {
    Vec3f o, x, y, z;
    float x0, y0, z0, x1, y1;
    float b0, b1, k;
    float solid_angle;

    /// corner, unit axes and lengths of two perpendicular edges, z = x cross y; o: the point that
    /// looks.
    SphericalRectangle(Vec3f corner, Vec3f x, Vec3f y, Vec3f z, float length_x, float length_y,
                       Vec3f o);
    /// A point on the rectangle.
    Vec3f sample(Vec2f u) const;
};

}  // namespace tessera
