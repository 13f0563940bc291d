#pragma once
// How much light a rough dielectric boundary sends back, over all directions: what a base below it
// does not get.

namespace tessera {

/// Directional albedo of GGX reflection off a dielectric, single scattering. cos_o in (0, 1], alpha
/// in [0, 1], eta = index beyond over here, in [1, 4] (clamped). Interpolated from a table made at
/// the first call by quadrature over the visible normals; absolute error below 0.01
/// (tests/stats/furnace_test.cpp).
float dielectric_reflection_albedo(float cos_o, float alpha, float eta) noexcept;

/// The same along cos_o alone, for a boundary that does not vary: by quadrature, once per material.
class ReflectionAlbedoCurve {
public:
    ReflectionAlbedoCurve(float alpha, float eta);
    float operator()(float cos_o) const noexcept;

private:
    static constexpr int kCells = 64;
    float values_[kCells];
};

/// The same by quadrature with n x n points; for the table and its test.
float dielectric_reflection_albedo_quadrature(float cos_o, float alpha, float eta, int n) noexcept;

}  // namespace tessera
