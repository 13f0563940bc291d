#pragma once
// Affine maps: a 3x3 linear part given by its columns, and a translation.

#include <array>
#include <cmath>

#include "renderer/core/vec.h"

namespace tessera {

template <class T>
struct Affine {
    Vec3<T> x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  // images of the axes (columns)
    Vec3<T> p{};                                 // image of the origin

    constexpr Affine() = default;
    constexpr Affine(Vec3<T> x_, Vec3<T> y_, Vec3<T> z_, Vec3<T> p_) : x(x_), y(y_), z(z_), p(p_) {}
    template <class U>
    constexpr explicit Affine(const Affine<U>& b) : x(b.x), y(b.y), z(b.z), p(b.p) {}

    constexpr Vec3<T> vector(Vec3<T> v) const { return x * v.x + y * v.y + z * v.z; }
    constexpr Vec3<T> point(Vec3<T> v) const { return vector(v) + p; }
    /// Transposed linear part times v.
    constexpr Vec3<T> transposed(Vec3<T> v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
    constexpr T determinant() const { return dot(x, cross(y, z)); }
    /// Cofactor matrix times n: the inverse transpose up to the determinant's magnitude, with its
    /// sign kept positive, so that a mirrored instance still has its normals on the outside.
    constexpr Vec3<T> normal(Vec3<T> n) const {
        const Vec3<T> m = cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
        return determinant() < T(0) ? -m : m;
    }
    constexpr Affine operator*(const Affine& b) const {
        return {vector(b.x), vector(b.y), vector(b.z), point(b.p)};
    }
    constexpr bool operator==(const Affine&) const = default;
};

using Affinef = Affine<float>;
using Affined = Affine<double>;

/// From 3 rows of 4, row-major (the layout of scene files).
inline Affined affine_from_rows(const std::array<double, 12>& m) {
    return {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
}

inline Affined translation(Vec3d by) { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, by}; }

/// Inverse; the caller has checked that the determinant is not zero.
inline Affined inverse(const Affined& a) {
    const double d = 1.0 / a.determinant();
    const Vec3d r0 = cross(a.y, a.z) * d, r1 = cross(a.z, a.x) * d, r2 = cross(a.x, a.y) * d;
    Affined b{{r0.x, r1.x, r2.x}, {r0.y, r1.y, r2.y}, {r0.z, r1.z, r2.z}, {}};
    b.p = -b.vector(a.p);
    return b;
}

}  // namespace tessera
