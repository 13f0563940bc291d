#pragma once
// Independent random numbers for statistical tests: the renderer's own points are stratified, which
// a chi-square test would take for too good a fit.

#include <cstdint>

#include "renderer/core/vec.h"

namespace tessera {

/// Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014 (SplitMix64).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    /// In [0, 1), on the grid of 2^-24 that the sampler has too.
    float unit() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }
    float between(float lo, float hi) { return lo + (hi - lo) * unit(); }
    Vec2f pair() {
        const float x = unit();
        return {x, unit()};
    }
    /// Uniform on the sphere.
    Vec3d direction() {
        const double z = 2 * static_cast<double>(unit()) - 1,
                     a = 6.283185307179586 * static_cast<double>(unit());
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        return {r * std::cos(a), r * std::sin(a), z};
    }

private:
    std::uint64_t state_;
};

/// On the upper hemisphere, a little off its rim.
inline Vec3f upper_direction(Random& n) {
    Vec3d w = n.direction();
    w.z = std::fabs(w.z) + 1e-3;
    return Vec3f(normalize(w));
}

}  // namespace tessera
