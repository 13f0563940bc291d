#include "materials/energy.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "materials/fresnel.h"
#include "materials/ggx.h"

namespace tessera {
namespace {

constexpr int kMu = 32, kAlpha = 32, kEta = 16;

// The axes are bent so that cells are small where the albedo curves: near grazing, near smooth,
// near eta = 1.
float mu_at(float x) { return std::max(x * x, 1e-4f); }
float alpha_at(float x) { return x * x; }
float eta_at(float x) { return 1.0f + 3.0f * x * x * x; }

struct Table {
    std::array<float, kMu * kAlpha * kEta> values;
    Table() {
        for (int e = 0; e < kEta; ++e) {
            for (int a = 0; a < kAlpha; ++a) {
                for (int m = 0; m < kMu; ++m) {
                    values[(e * kAlpha + a) * kMu + m] = dielectric_reflection_albedo_quadrature(
                        mu_at(static_cast<float>(m) / (kMu - 1)),
                        alpha_at(static_cast<float>(a) / (kAlpha - 1)),
                        eta_at(static_cast<float>(e) / (kEta - 1)), 12);
                }
            }
        }
    }
};

struct Cell {
    int i;
    float t;
};

Cell cell(float x, int n) {
    const float p = clamp01(x) * static_cast<float>(n - 1);
    const int i = std::min(static_cast<int>(p), n - 2);
    return {i, p - static_cast<float>(i)};
}

}  // namespace

float dielectric_reflection_albedo_quadrature(float cos_o, float alpha, float eta, int n) noexcept {
    const Vec3f wo{safe_sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o};
    const Ggx ggx{std::max(alpha, 1e-4f), std::max(alpha, 1e-4f)};
    const float g1 = ggx.g1(wo);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const Vec2f u{(static_cast<float>(i) + 0.5f) / static_cast<float>(n),
                          (static_cast<float>(j) + 0.5f) / static_cast<float>(n)};
            const Vec3f h = ggx.sample_visible(wo, u);
            const Vec3f wi = reflect(wo, h);
            if (wi.z > 0.0f)
                sum += static_cast<double>(fresnel_dielectric(clamp01(dot(wo, h)), eta) *
                                           ggx.g2(wo, wi) / g1);
        }
    }
    return static_cast<float>(sum / (static_cast<double>(n) * n));
}

float dielectric_reflection_albedo(float cos_o, float alpha, float eta) noexcept {
    static const Table table;
    const Cell m = cell(safe_sqrt(cos_o), kMu), a = cell(safe_sqrt(alpha), kAlpha),
               e = cell(std::cbrt(std::max(eta - 1.0f, 0.0f) * (1.0f / 3.0f)), kEta);
    float sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int dm = corner & 1, da = (corner >> 1) & 1, de = corner >> 2;
        const float w = (dm ? m.t : 1 - m.t) * (da ? a.t : 1 - a.t) * (de ? e.t : 1 - e.t);
        sum += w * table.values[((e.i + de) * kAlpha + a.i + da) * kMu + m.i + dm];
    }
    return sum;
}

ReflectionAlbedoCurve::ReflectionAlbedoCurve(float alpha, float eta) {
    for (int i = 0; i < kCells; ++i) {
        const float mu = mu_at(static_cast<float>(i) / (kCells - 1));
        values_[i] = dielectric_reflection_albedo_quadrature(mu, alpha, eta, 24);
    }
}

float ReflectionAlbedoCurve::operator()(float cos_o) const noexcept {
    const Cell c = cell(safe_sqrt(cos_o), kCells);
    return values_[c.i] + (values_[c.i + 1] - values_[c.i]) * c.t;
}

}  // namespace tessera
