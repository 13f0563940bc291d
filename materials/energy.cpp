#include "materials/energy.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "materials/fresnel.h"
#include "materials/ggx.h"

namespace tessera {
namespace {

// The axes are bent so that cells are small where the albedo curves: near grazing, near smooth,
// near eta = 1.
float mu_at(float x) { return std::max(x * x, 1e-4f); }
float alpha_at(float x) { return x * x; }
float eta_at(float x) { return 1.0f + 3.0f * x * x * x; }
// Beyond that little changes, and that with 1 / eta.
constexpr float kFarEta = 4, kMostEta = 100;
float far_eta_at(float x) {
    return 1.0f / (1.0f / kFarEta + (1.0f / kMostEta - 1.0f / kFarEta) * x);
}
float far_eta_place(float eta) {
    return (1.0f / kFarEta - 1.0f / eta) / (1.0f / kFarEta - 1.0f / kMostEta);
}

struct Cell {
    int i;
    float t;
};

Cell cell(float x, int n) {
    const float p = clamp01(x) * static_cast<float>(n - 1);
    const int i = std::min(static_cast<int>(p), n - 2);
    return {i, p - static_cast<float>(i)};
}

float unit(int i, int n) { return static_cast<float>(i) / static_cast<float>(n - 1); }

/// Values over mu, alpha and eta, mu running fastest.
class Table {
public:
    template <class Quadrature>
    Table(int mus, int alphas, int etas, Quadrature value, bool far = false)
        : mus_(mus), alphas_(alphas), etas_(etas), far_(far) {
        for (int e = 0; e < etas; ++e)
            for (int a = 0; a < alphas; ++a)
                for (int m = 0; m < mus; ++m)
                    values_.push_back(value(mu_at(unit(m, mus)), alpha_at(unit(a, alphas)),
                                            etas > 1 ? eta_of(unit(e, etas)) : 1.0f));
    }
    float operator()(float cos_o, float alpha, float eta) const {
        const Cell m = cell(safe_sqrt(cos_o), mus_), a = cell(safe_sqrt(alpha), alphas_),
                   e = etas_ > 1 ? cell(place_of(eta), etas_) : Cell{0, 0};
        float sum = 0;
        for (int corner = 0; corner < (etas_ > 1 ? 8 : 4); ++corner) {
            const int dm = corner & 1, da = (corner >> 1) & 1, de = corner >> 2;
            const float w = (dm ? m.t : 1 - m.t) * (da ? a.t : 1 - a.t) * (de ? e.t : 1 - e.t);
            const int at = ((e.i + de) * alphas_ + a.i + da) * mus_ + m.i + dm;
            sum += w * values_[static_cast<std::size_t>(at)];
        }
        return sum;
    }

private:
    float eta_of(float x) const { return far_ ? far_eta_at(x) : eta_at(x); }
    float place_of(float eta) const {
        return far_ ? far_eta_place(eta)
                    : std::cbrt(std::max(eta - 1.0f, 0.0f) * (1.0f / (kFarEta - 1.0f)));
    }

    int mus_, alphas_, etas_;
    bool far_ = false;  // eta from kFarEta on
    std::vector<float> values_;
};

// The mean over visible normals of share(wo, h, masking of a direction), n x n of them along a
// golden spiral: half of them, the other half is its mirror image.
template <class Share>
float over_normals(float cos_o, float alpha, int n, Share share) {
    const Vec3f wo{safe_sqrt(1.0f - cos_o * cos_o), 0.0f, cos_o};
    const Ggx ggx{std::max(alpha, 1e-4f), std::max(alpha, 1e-4f)};
    const float g1 = ggx.g1(wo);
    const auto masking = [&](Vec3f wi) { return ggx.g2(wo, {wi.x, wi.y, std::fabs(wi.z)}) / g1; };
    const auto count = static_cast<std::uint32_t>(n * n);
    double sum = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double golden = static_cast<double>(i) * 0.61803398874989485;
        const auto turn = static_cast<float>(0.5 * (golden - std::floor(golden)));
        const Vec2f u{turn, (static_cast<float>(i) + 0.5f) / static_cast<float>(count)};
        sum += static_cast<double>(share(wo, ggx.sample_visible(wo, u), masking));
    }
    return static_cast<float>(sum / static_cast<double>(count));
}

}  // namespace

float dielectric_reflection_albedo_quadrature(float cos_o, float alpha, float eta, int n) noexcept {
    return over_normals(cos_o, alpha, n, [&](Vec3f wo, Vec3f h, const auto& masking) {
        const Vec3f wi = reflect(wo, h);
        return wi.z > 0.0f ? fresnel_dielectric(clamp01(dot(wo, h)), eta) * masking(wi) : 0.0f;
    });
}

float mirror_albedo_quadrature(float cos_o, float alpha, int n) noexcept {
    return over_normals(cos_o, alpha, n, [](Vec3f wo, Vec3f h, const auto& masking) {
        const Vec3f wi = reflect(wo, h);
        return wi.z > 0.0f ? masking(wi) : 0.0f;
    });
}

float glass_albedo_quadrature(float cos_o, float alpha, float eta, int n) noexcept {
    return over_normals(cos_o, alpha, n, [&](Vec3f wo, Vec3f h, const auto& masking) {
        const float oh = clamp01(dot(wo, h));
        const float fresnel = fresnel_dielectric(oh, eta);
        const Vec3f r = reflect(wo, h), t = refract(wo, h, eta, refracted_cosine(oh, eta));
        const float up = r.z > 0.0f ? fresnel * masking(r) : 0.0f;
        const float down = fresnel < 1.0f && t.z < 0.0f ? (1.0f - fresnel) * masking(t) : 0.0f;
        return up + down;
    });
}

float fresnel_node(int i) noexcept { return mu_at(unit(i, kFresnelNodes)); }

FresnelWeights fresnel_interpolation(float cosine) noexcept {
    const Cell c = cell(safe_sqrt(cosine), kFresnelNodes);
    FresnelWeights w{};
    w[static_cast<std::size_t>(c.i)] = 1.0f - c.t;
    w[static_cast<std::size_t>(c.i) + 1] = c.t;
    return w;
}

FresnelWeights fresnel_weights_quadrature(float cos_o, float alpha, int n) noexcept {
    FresnelWeights sum{};
    over_normals(cos_o, alpha, n, [&](Vec3f wo, Vec3f h, const auto& masking) {
        const Vec3f wi = reflect(wo, h);
        if (!(wi.z > 0.0f)) return 0.0f;
        const FresnelWeights at = fresnel_interpolation(clamp01(dot(wo, h)));
        const float share = masking(wi) / static_cast<float>(n * n);
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += at[k] * share;
        return share;
    });
    return sum;
}

FresnelWeights fresnel_weights(float cos_o, float alpha) noexcept {
    constexpr int kMus = 32, kAlphas = 24;
    static const std::vector<FresnelWeights> table = [] {
        std::vector<FresnelWeights> t;
        for (int a = 0; a < kAlphas; ++a)
            for (int m = 0; m < kMus; ++m)
                t.push_back(fresnel_weights_quadrature(mu_at(unit(m, kMus)),
                                                       alpha_at(unit(a, kAlphas)), 32));
        return t;
    }();
    const Cell m = cell(safe_sqrt(cos_o), kMus), a = cell(safe_sqrt(alpha), kAlphas);
    FresnelWeights sum{};
    for (int corner = 0; corner < 4; ++corner) {
        const int dm = corner & 1, da = corner >> 1;
        const float w = (dm ? m.t : 1 - m.t) * (da ? a.t : 1 - a.t);
        const int place = (a.i + da) * kMus + m.i + dm;
        const FresnelWeights& at = table[static_cast<std::size_t>(place)];
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += w * at[k];
    }
    return sum;
}

float dielectric_reflection_albedo(float cos_o, float alpha, float eta) noexcept {
    const auto into = [](float mu, float a, float e) {
        return dielectric_reflection_albedo_quadrature(mu, a, e, 12);
    };
    const auto out = [](float mu, float a, float e) {
        return dielectric_reflection_albedo_quadrature(mu, a, 1.0f / e, 12);
    };
    if (eta < 1.0f) {
        static const Table near(32, 32, 16, out), far(32, 32, 8, out, true);
        return (eta < 1.0f / kFarEta ? far : near)(cos_o, alpha, 1.0f / eta);
    }
    if (eta > kFarEta) {
        static const Table far(32, 32, 8, into, true);
        return far(cos_o, alpha, eta);
    }
    static const Table near(32, 32, 16, into);
    return near(cos_o, alpha, eta);
}

float mirror_albedo(float cos_o, float alpha) noexcept {
    static const Table table(
        32, 32, 1, [](float mu, float a, float) { return mirror_albedo_quadrature(mu, a, 32); });
    return table(cos_o, alpha, 1);
}

float glass_albedo(float cos_o, float alpha, float eta) noexcept {
    const auto into = [](float mu, float a, float e) {
        return glass_albedo_quadrature(mu, a, e, 16);
    };
    const auto out = [](float mu, float a, float e) {
        return glass_albedo_quadrature(mu, a, 1.0f / e, 16);
    };
    if (eta > kFarEta || eta < 1.0f / kFarEta) {
        static const Table far_into(40, 24, 8, into, true), far_out(40, 24, 8, out, true);
        return eta >= 1.0f ? far_into(cos_o, alpha, eta) : far_out(cos_o, alpha, 1.0f / eta);
    }
    static const Table near_into(40, 24, 16, into), near_out(40, 24, 16, out);
    return eta >= 1.0f ? near_into(cos_o, alpha, eta) : near_out(cos_o, alpha, 1.0f / eta);
}

template <class Quadrature>
AlbedoCurve::AlbedoCurve(Quadrature quadrature) {
    for (int i = 0; i < kCells; ++i) values_[i] = quadrature(mu_at(unit(i, kCells)));
}

AlbedoCurve AlbedoCurve::dielectric(float alpha, float eta) {
    return AlbedoCurve(
        [&](float mu) { return dielectric_reflection_albedo_quadrature(mu, alpha, eta, 32); });
}

AlbedoCurve AlbedoCurve::mirror(float alpha) {
    return AlbedoCurve([&](float mu) { return mirror_albedo_quadrature(mu, alpha, 32); });
}

AlbedoCurve AlbedoCurve::glass(float alpha, float eta) {
    return AlbedoCurve([&](float mu) { return glass_albedo_quadrature(mu, alpha, eta, 32); });
}

}  // namespace tessera
