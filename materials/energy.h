#pragma once
// How much light a rough boundary sends back or lets through in one bounce, over all directions:
// what a base below it does not get, and what bouncing between the microfacets has to give back.
// Interpolated from tables made by quadrature at the first call; absolute error below 0.01
// (tests/stats/furnace_test.cpp).

#include <algorithm>
#include <array>

#include "renderer/core/vec.h"

namespace tessera {

/// Directional albedo of GGX reflection off a dielectric. cos_o in (0, 1], alpha in [0, 1], eta =
/// index beyond over here, in [1/100, 100] (clamped).
float dielectric_reflection_albedo(float cos_o, float alpha, float eta) noexcept;
/// The same of a boundary that reflects everything: what is lost is lost to single scattering.
float mirror_albedo(float cos_o, float alpha) noexcept;
/// Reflected and transmitted together; eta in [1/100, 100] (clamped).
float glass_albedo(float cos_o, float alpha, float eta) noexcept;

/// One of them along cos_o alone, for a boundary that does not vary: by quadrature, once per
/// material.
class AlbedoCurve {
public:
    static AlbedoCurve dielectric(float alpha, float eta);
    static AlbedoCurve mirror(float alpha);
    static AlbedoCurve glass(float alpha, float eta);
    // Along the root of the cosine, where it curves least; in the header: a hot leaf.
    float operator()(float cos_o) const noexcept {
        const float at = clamp01(safe_sqrt(cos_o)) * static_cast<float>(kCells - 1);
        const int i = std::min(static_cast<int>(at), kCells - 2);
        return values_[i] + (values_[i + 1] - values_[i]) * (at - static_cast<float>(i));
    }

private:
    template <class Quadrature>
    explicit AlbedoCurve(Quadrature quadrature);

    static constexpr int kCells = 64;
    float values_[kCells];
};

/// Fresnel curves of any shape, known at a few cosines: a lobe's albedo is a sum over them, as a
/// hemisphere's is by any quadrature, with weights that hold what GGX sends there.
inline constexpr int kFresnelNodes = 24;
using FresnelWeights = std::array<float, kFresnelNodes>;
float fresnel_node(int i) noexcept;
/// Weights by which a curve's values at the nodes make the directional albedo of its GGX
/// reflection. They add up to mirror_albedo.
FresnelWeights fresnel_weights(float cos_o, float alpha) noexcept;
/// Weights by which they make the curve's value at a cosine.
FresnelWeights fresnel_interpolation(float cosine) noexcept;

/// By quadrature with n x n points; for the tables and their tests.
float dielectric_reflection_albedo_quadrature(float cos_o, float alpha, float eta, int n) noexcept;
float mirror_albedo_quadrature(float cos_o, float alpha, int n) noexcept;
FresnelWeights fresnel_weights_quadrature(float cos_o, float alpha, int n) noexcept;
float glass_albedo_quadrature(float cos_o, float alpha, float eta, int n) noexcept;

}  // namespace tessera
