#pragma once
// Small vectors. Plain aggregates; component-wise operators; float for tracing, double for placing.

#include <algorithm>
#include <array>
#include <cmath>

namespace tessera {

template <class T>
struct Vec2 {
    T x{}, y{};
    constexpr Vec2 operator+(Vec2 b) const { return {x + b.x, y + b.y}; }
    constexpr Vec2 operator-(Vec2 b) const { return {x - b.x, y - b.y}; }
    constexpr Vec2 operator*(T s) const { return {x * s, y * s}; }
    constexpr bool operator==(const Vec2&) const = default;
};

template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr Vec3() = default;
    constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    constexpr explicit Vec3(T s) : x(s), y(s), z(s) {}
    constexpr explicit Vec3(const std::array<T, 3>& a) : x(a[0]), y(a[1]), z(a[2]) {}
    template <class U>
    constexpr explicit Vec3(const Vec3<U>& b)
        : x(static_cast<T>(b.x)), y(static_cast<T>(b.y)), z(static_cast<T>(b.z)) {}

    constexpr T operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
    constexpr Vec3 operator-() const { return {-x, -y, -z}; }
    constexpr Vec3 operator+(Vec3 b) const { return {x + b.x, y + b.y, z + b.z}; }
    constexpr Vec3 operator-(Vec3 b) const { return {x - b.x, y - b.y, z - b.z}; }
    constexpr Vec3 operator*(Vec3 b) const { return {x * b.x, y * b.y, z * b.z}; }
    constexpr Vec3 operator*(T s) const { return {x * s, y * s, z * s}; }
    constexpr Vec3 operator/(T s) const { return *this * (T(1) / s); }
    constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
    constexpr Vec3& operator*=(Vec3 b) { return *this = *this * b; }
    constexpr Vec3& operator*=(T s) { return *this = *this * s; }
    constexpr bool operator==(const Vec3&) const = default;
};

template <class T>
constexpr Vec3<T> operator*(T s, Vec3<T> a) {
    return a * s;
}

using Vec2f = Vec2<float>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
/// Linear colour in the working space.
using Color = Vec3f;

template <class T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length2(Vec3<T> a) {
    return dot(a, a);
}
template <class T>
T length(Vec3<T> a) {
    return std::sqrt(dot(a, a));
}
template <class T>
Vec3<T> normalize(Vec3<T> a) {
    return a / length(a);
}
template <class T>
Vec3<T> abs(Vec3<T> a) {
    return {std::abs(a.x), std::abs(a.y), std::abs(a.z)};
}
template <class T>
constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
    return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <class T>
constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
    return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <class T>
constexpr T max_component(Vec3<T> a) {
    return std::max(a.x, std::max(a.y, a.z));
}
template <class T>
constexpr T min_component(Vec3<T> a) {
    return std::min(a.x, std::min(a.y, a.z));
}
/// One test for all three: nothing that is not finite gives zero times zero.
template <class T>
bool is_finite(Vec3<T> a) {
    return a.x * T(0) + a.y * T(0) + a.z * T(0) == T(0);
}
template <class T>
constexpr Vec3<T> lerp(Vec3<T> a, Vec3<T> b, T t) {
    return a * (T(1) - t) + b * t;
}

constexpr float sqr(float x) { return x * x; }
constexpr float clamp01(float x) { return x < 0.0f ? 0.0f : (x > 1.0f ? 1.0f : x); }
/// sqrt that takes rounding below zero as zero.
inline float safe_sqrt(float x) { return std::sqrt(x > 0.0f ? x : 0.0f); }

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kInvPi = 0.31830988618379067154f;
inline constexpr float kInfinity = __builtin_inff();

/// a if `yes`, else b, by a blend: both are computed.
inline float pick(bool yes, float a, float b) { return yes ? a : b; }
inline Vec3f pick(bool yes, Vec3f a, Vec3f b) {
    return {yes ? a.x : b.x, yes ? a.y : b.y, yes ? a.z : b.z};
}

}  // namespace tessera
