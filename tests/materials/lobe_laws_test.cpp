// What physics asks of every lobe: reciprocity, Snell's law, no light lost at a smooth boundary.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/support/lobe_probe.h"
#include "tests/support/parallel_cases.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

template <class Model>
double worst_asymmetry(const Model& m, std::uint64_t seed) {
    Random n(seed);
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3f a = upper_direction(n), b = upper_direction(n);
        const double ab = bsdf(m, a, b), ba = bsdf(m, b, a);
        if (ab > 1e-6 || ba > 1e-6) worst = std::max(worst, std::fabs(ab - ba) / std::max(ab, ba));
    }
    return worst;
}

// Born & Wolf, section 1.5.2, in double.
double fresnel_double(double cos_i, double eta) {
    const double sin2 = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2 >= 1) return 1;
    const double cos_t = std::sqrt(1 - sin2);
    const double rs = (cos_i - eta * cos_t) / (cos_i + eta * cos_t),
                 rp = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5 * (rs * rs + rp * rp);
}

}  // namespace

// 1e-4: the half vector's rounding, 1e-7, over an alpha of 0.0025, twice.
TEST_CASE("reflection lobes: both ways have the same value") {
    CHECK(worst_asymmetry(DiffuseLobe{}, 1) < 1e-5);
    for (const float roughness : {0.1f, 0.3f, 0.6f, 1.0f}) {
        for (const float anisotropy : {0.0f, 0.7f}) {
            CAPTURE(roughness);
            CAPTURE(anisotropy);
            const Ggx ggx = openpbr_ggx(roughness, anisotropy);
            CHECK(worst_asymmetry(RoughReflection<DielectricFresnel>{ggx, {1.5f}, Color(1.0f)}, 2) <
                  2e-4);
            CHECK(worst_asymmetry(
                      RoughReflection<MetalFresnel>{ggx, {Color(0.7f), Color(0.9f)}, Color(1.0f)},
                      3) < 2e-4);
            CHECK(worst_asymmetry(rough_glass(ggx, 1.5f), 4) < 2e-4);
        }
    }
}

TEST_CASE("rough glass: both ways through have the same value but for the square of the index") {
    // Veach 1997, eq. 5.14: bsdf(wo, wi) eta^2 = bsdf(wi, wo), eta = index on wi's side over wo's.
    for (const float roughness : {0.1f, 0.4f, 1.0f}) {
        for (const float eta : {1.05f, 1.5f, 2.5f, 0.5f}) {
            CAPTURE(roughness);
            CAPTURE(eta);
            const Ggx ggx = openpbr_ggx(roughness, 0.5f);
            const auto here = rough_glass(ggx, eta), there = rough_glass(ggx, 1 / eta);
            Random n(7);
            double worst = 0;
            int compared = 0;
            for (int i = 0; i < 20000; ++i) {
                const Vec3f a = upper_direction(n), b = -upper_direction(n);
                const double ab = bsdf(here, a, b) * static_cast<double>(eta * eta);
                // Seen from the other side: turned about x, so that b is up.
                const double ba = bsdf(there, {b.x, -b.y, -b.z}, {a.x, -a.y, -a.z});
                if (ab < 1e-5 && ba < 1e-5) continue;
                // Where next to nothing is let through, 1 - Fresnel is rounding.
                const Vec3d h = normalize(Vec3d(a) + Vec3d(b) * static_cast<double>(eta));
                if (fresnel_double(std::fabs(dot(h, Vec3d(a))), static_cast<double>(eta)) > 0.9)
                    continue;
                worst = std::max(worst, std::fabs(ab - ba) / std::max(ab, ba));
                ++compared;
            }
            CHECK(worst <
                  3e-3);  // rounding of wo + eta wi and of 1 - Fresnel near the critical angle
            CHECK(compared > 50);
        }
    }
}

TEST_CASE("smooth glass: refracts by Snell's law and loses nothing") {
    Random n(11);
    for (int i = 0; i < 20000; ++i) {
        const float eta = i % 2 ? n.between(1.01f, 2.5f) : 1 / n.between(1.01f, 2.5f);
        const Vec3f wo = upper_direction(n);
        const auto glass = smooth_glass(eta);
        const double fresnel = fresnel_double(static_cast<double>(wo.z), static_cast<double>(eta));
        const double used = static_cast<double>(fresnel_dielectric(wo.z, eta));
        // Near the critical angle Fresnel rises like a root: rounding of 1e-7 shows as its square
        // root.
        REQUIRE(std::fabs(used - fresnel) < 2e-3);
        if (std::fabs(fresnel - 1) > 0.05) REQUIRE(std::fabs(used - fresnel) < 1e-4);
        const auto up = LobeProbe(glass, wo).sample({}, static_cast<float>(0.5 * used));
        REQUIRE(up);
        REQUIRE(up->delta);
        REQUIRE(up->wi == Vec3f{-wo.x, -wo.y, wo.z});
        REQUIRE(std::fabs(up->weight.x - 1.0f) < 1e-6f);
        if (!(used < 1)) continue;
        const auto down = LobeProbe(glass, wo).sample({}, 0x1.fffffep-1f);
        REQUIRE(down);
        REQUIRE(down->wi.z < 0.0f);
        REQUIRE(down->eta == eta);
        // Energy: the weight without radiance's 1/eta^2 is one, and the shares add to one.
        REQUIRE(std::fabs(static_cast<double>(down->weight.x) * static_cast<double>(eta) *
                              static_cast<double>(eta) -
                          1) < 1e-5);
        const Vec3d o(wo), t(down->wi);
        REQUIRE(std::fabs(t.x * static_cast<double>(eta) + o.x) < 1e-6);
        REQUIRE(std::fabs(t.y * static_cast<double>(eta) + o.y) < 1e-6);
        REQUIRE(std::fabs(length2(t) - 1) < 1e-6);
    }
}

TEST_CASE("smooth lobes: reflected and transmitted shares come as often as they weigh") {
    Random n(13);
    for (const float eta : {1.3f, 1.5f, 0.7f}) {
        for (const float z : {0.999f, 0.6f, 0.2f}) {
            const Vec3f wo = normalize(Vec3f{safe_sqrt(1 - z * z), 0, z});
            const double f = fresnel_double(static_cast<double>(wo.z), static_cast<double>(eta));
            const double thin_r =
                f + (f < 1 ? (1 - f) * (1 - f) * f / (1 - f * f) : 0);  // the sum of all bounces
            int glass = 0, thin = 0;
            constexpr int kTries = 100000;
            for (int i = 0; i < kTries; ++i) {
                glass += LobeProbe(smooth_glass(eta), wo).sample({}, n.unit())->wi.z > 0.0f;
                thin += LobeProbe(smooth_sheet(eta), wo).sample({}, n.unit())->wi.z > 0.0f;
            }
            CAPTURE(eta);
            CAPTURE(z);
            // 4.5 sigma of a count
            const auto slack = [](double p) { return 4.5 * std::sqrt(p * (1 - p) * kTries) + 1; };
            CHECK(std::fabs(glass - f * kTries) < slack(f));
            CHECK(std::fabs(thin - thin_r * kTries) < slack(thin_r));
            const auto straight = LobeProbe(smooth_sheet(eta), wo).sample({}, 0x1.fffffep-1f);
            if (f < 1) CHECK(straight->wi == -wo);
        }
    }
}

TEST_CASE("smooth reflection: the weight is Fresnel's reflectance") {
    for (const float z : {1.0f, 0.5f, 0.1f, 0.01f}) {
        const Vec3f wo{safe_sqrt(1 - z * z), 0, z};
        const auto dielectric =
            LobeProbe(SmoothReflection<DielectricFresnel>{{1.5f}}, wo).sample({}, 0);
        CHECK(dielectric->weight.x ==
              doctest::Approx(fresnel_double(static_cast<double>(z), 1.5)).epsilon(1e-5));
        const auto mirror =
            LobeProbe(SmoothReflection<MetalFresnel>{{Color(1.0f), Color(1.0f)}}, wo).sample({}, 0);
        CHECK(mirror->weight == Color(1.0f));
    }
}
