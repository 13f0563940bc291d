// Films and coats over boundaries, rough ones too: no light is made, and what has no optical effect
// is not seen. Coats against the exact sum over two interfaces.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "renderer/core/sampler.h"
#include "tests/support/lobe_probe.h"
#include "tests/support/parallel_cases.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

Vec3f seen_at(float cosine) { return {safe_sqrt(1 - cosine * cosine), 0, cosine}; }

// Energy sent to all directions; error below 2e-3: 2^13 stratified points.
Vec3d albedo_of(const LobeProbe& lobes) {
    constexpr std::uint32_t kPoints = 1u << 13;
    Vec3d sum;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const auto s = lobes.sample(sample_pair(77, i, 0), sample_pair(77, i, 1).x);
        if (s) sum += Vec3d(s->weight) * static_cast<double>(s->eta * s->eta);
    }
    return sum / kPoints;
}

Vec3d albedo_of(const SurfaceParams& p, float cosine) {
    return albedo_of(LobeProbe(p, seen_at(cosine), true));
}

SurfaceParams filmed(float roughness, float film_ior, float thickness) {
    SurfaceParams p;
    p.base_color = Color(1.0f);
    p.specular_roughness = roughness;
    p.thin_film_weight = 1;
    p.thin_film_ior = film_ior;
    p.thin_film_thickness = thickness;
    return p;
}

struct FilmCase {
    SurfaceParams p;
    float cosine;
};

// Reflectance of a smooth clear coat over a smooth metal at normal incidence: all bounces between
// the two summed.
double two_interfaces(double metal, double coat_ior) {
    const double r = (coat_ior - 1) / (coat_ior + 1), f = r * r;
    return f + (1 - f) * (1 - f) * metal / (1 - f * metal);
}

}  // namespace

// 0.012: the tables of a rough boundary's losses are good to 0.01.
TEST_CASE("thin film: a white surface under one gives back all light and no more, however rough") {
    std::vector<FilmCase> cases;
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.8f, 1.0f})
        for (const float ior : {1.1f, 1.33f, 1.6f, 2.0f, 2.5f})
            for (const float thickness : {0.05f, 0.45f, 1.2f})
                for (const float cosine : {1.0f, 0.7f, 0.5f, 0.26f, 0.09f, 0.0175f})
                    cases.push_back({filmed(roughness, ior, thickness), cosine});
    CHECK(failures_of(cases, [](const FilmCase& c) -> std::string {
              const Vec3d a = albedo_of(c.p, c.cosine);
              if (max_component(a) <= 1.012 && min_component(a) >= 0.988) return "";
              return fmt::format("roughness {} film {} {} um cosine {}: {:.4f} {:.4f} {:.4f}\n",
                                 c.p.specular_roughness, c.p.thin_film_ior, c.p.thin_film_thickness,
                                 c.cosine, a.x, a.y, a.z);
          }) == "");
}

TEST_CASE("thin film: rough sheets of it lose and make no light") {
    for (const float roughness : {0.2f, 0.6f, 1.0f})
        for (const float cosine : {1.0f, 0.5f, 0.1f}) {
            SurfaceParams p = filmed(roughness, 1.4f, 0.4f);
            p.transmission_weight = 1;
            p.thin_walled = true;
            const Vec3d a = albedo_of(p, cosine);
            CAPTURE(roughness);
            CAPTURE(cosine);
            CHECK(max_component(a) < 1.012);
            CHECK(min_component(a) > 0.988);
        }
}

TEST_CASE("thin film: one of the coat's index or of the base's is not there") {
    const auto with = [](float film_ior, float weight, float roughness, int base, float ior) {
        SurfaceParams p = filmed(roughness, film_ior, 0.4f);
        p.base_color = Color(base == 1 ? 0.7f : 0.0f);
        p.base_metalness = base == 1 ? 1.0f : 0.0f;
        p.transmission_weight = base == 2 ? 1.0f : 0.0f;
        p.specular_ior = ior;
        p.coat_weight = 1;
        p.coat_ior = 1.6f;
        p.thin_film_weight = weight;
        return p;
    };
    for (const float roughness : {0.0f, 0.4f})
        for (const int base : {0, 1, 2})
            for (const float ior : {1.8f, 1.4f})
                for (const float cosine : {1.0f, 0.6f, 0.2f}) {
                    CAPTURE(roughness);
                    CAPTURE(base);
                    CAPTURE(ior);
                    CAPTURE(cosine);
                    // Glass under a coat is still entered from air, and so is what lies on it: a
                    // film on a thinner base is looked at from the base's side.
                    if (base == 0 && ior < 1.6f) continue;
                    // Rough glass is given back what it loses to bounces only without a film.
                    if (base == 2 && roughness > 0.0f) continue;
                    const Vec3d film = albedo_of(with(1.6f, 1, roughness, base, ior), cosine),
                                none = albedo_of(with(1.6f, 0, roughness, base, ior), cosine);
                    // 2e-3: a rough boundary's albedo by Fresnel nodes and by its own table.
                    CHECK(max_component(abs(film - none)) < 2e-3);
                    if (base != 0) continue;
                    const Vec3d same = albedo_of(with(ior, 1, roughness, base, ior), cosine);
                    CHECK(max_component(abs(same - none)) < 2e-3);
                }
    // What the same film does without a coat is seen.
    SurfaceParams bare = with(1.6f, 1, 0.0f, 0, 1.8f), without = bare;
    bare.coat_weight = without.coat_weight = 0;
    without.thin_film_weight = 0;
    CHECK(max_component(abs(albedo_of(bare, 1) - albedo_of(without, 1))) > 0.01);
}

TEST_CASE("coat: over smooth metal it is the sum over two interfaces") {
    for (const double metal : {0.1, 0.5, 0.942, 1.0}) {
        for (const float ior : {1.2f, 1.6f, 2.5f}) {
            SurfaceParams p;
            p.base_metalness = 1;
            p.base_color = Color(static_cast<float>(metal));
            p.specular_roughness = 0;
            p.coat_weight = 1;
            p.coat_ior = ior;
            CAPTURE(metal);
            CAPTURE(ior);
            CHECK(albedo_of(p, 1).x ==
                  doctest::Approx(two_interfaces(metal, static_cast<double>(ior))).epsilon(2e-3));
        }
    }
}

TEST_CASE("coat: the rougher the metal below, the more it darkens, as far as a diffuse base") {
    double last = 2;
    for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f}) {
        SurfaceParams p;
        p.base_metalness = 1;
        p.base_color = Color(0.5f);
        p.specular_roughness = roughness;
        p.coat_weight = 1;
        const double a = albedo_of(p, 1).x;
        CAPTURE(roughness);
        CHECK(a < last);
        last = a;
    }
    // K_r = 0.652: 0.0533 + 0.9467 * 0.5 * 0.348 / (1 - 0.326), less what bounces among facets.
    CHECK(last < 0.298);
}

TEST_CASE("coat: a colour tints by the way light takes through it") {
    const auto albedo = [](bool metal, float color, float cosine) {
        SurfaceParams p;
        p.base_metalness = metal ? 1.0f : 0.0f;
        p.base_color = Color(1.0f);
        p.specular_weight = metal ? 1.0f : 0.0f;
        p.specular_roughness = 0;
        p.coat_weight = 1;
        p.coat_color = Color(color);
        return albedo_of(p, cosine).x - static_cast<double>(fresnel_dielectric(cosine, 1.6f));
    };
    for (const float cosine : {1.0f, 0.6f, 0.2f}) {
        CAPTURE(cosine);
        const double way = 1 / std::sqrt(1 - (1 - double(cosine) * double(cosine)) / (1.6 * 1.6));
        // A mirror: in as out. OpenPBR 1.1, "Coat", view-dependent absorption.
        CHECK(albedo(true, 0.25f, cosine) / albedo(true, 1, cosine) ==
              doctest::Approx(std::pow(0.25, way)).epsilon(2e-3));
        // A diffuse base: the mean over all ways in, by quadrature.
        double mean = 0;
        constexpr int kSteps = 10000;
        for (int i = 0; i < kSteps; ++i) {
            const double mu2 = (i + 0.5) / kSteps;
            mean += std::pow(0.5, 1 / std::sqrt(1 - (1 - mu2) / (1.6 * 1.6))) / kSteps;
        }
        CHECK(albedo(false, 0.25f, cosine) / albedo(false, 1, cosine) ==
              doctest::Approx(std::pow(0.5, way) * mean).epsilon(5e-3));
    }
}

TEST_CASE("extremes: no index, weight or film beyond the usual gives back more than it gets") {
    std::vector<FilmCase> cases;
    const auto add = [&](auto change) {
        for (const float roughness : {0.0f, 0.3f, 1.0f})
            for (const float cosine : {1.0f, 0.5f, 0.1f}) {
                SurfaceParams p;
                p.base_color = Color(1.0f);
                p.specular_roughness = p.coat_roughness = roughness;
                change(p);
                cases.push_back({p, cosine});
            }
    };
    for (const float ior : {0.01f, 0.1f, 0.5f, 5.0f, 10.0f, 40.0f, 100.0f}) {
        add([&](SurfaceParams& p) { p.specular_ior = ior; });
        add([&](SurfaceParams& p) { p.specular_ior = ior, p.base_color = Color(0.0f); });
        add([&](SurfaceParams& p) { p.specular_ior = ior, p.transmission_weight = 1; });
        add([&](SurfaceParams& p) {
            p.specular_ior = ior, p.transmission_weight = 1, p.thin_walled = true;
        });
        add([&](SurfaceParams& p) { p.coat_weight = 1, p.coat_ior = ior; });
        add([&](SurfaceParams& p) { p.coat_weight = 1, p.coat_ior = ior, p.base_metalness = 1; });
        add([&](SurfaceParams& p) {
            p.coat_weight = 0.5f, p.coat_ior = 1.6f, p.specular_ior = ior;
        });
        for (const float thickness : {0.1f, 0.5f}) {
            const auto film = [&](SurfaceParams& p) {
                p.thin_film_weight = 1, p.thin_film_ior = ior, p.thin_film_thickness = thickness;
            };
            add(film);
            add([&](SurfaceParams& p) { film(p), p.coat_weight = 1; });
            add([&](SurfaceParams& p) { film(p), p.transmission_weight = 1; });
            add([&](SurfaceParams& p) { film(p), p.base_metalness = 1; });
        }
    }
    for (const float weight : {1.5f, 4.0f, 100.0f, 1e10f}) {
        add([&](SurfaceParams& p) { p.specular_weight = weight; });
        add([&](SurfaceParams& p) { p.specular_weight = weight, p.transmission_weight = 1; });
        add([&](SurfaceParams& p) { p.specular_weight = weight, p.base_metalness = 1; });
        add([&](SurfaceParams& p) { p.specular_weight = weight, p.coat_weight = 1; });
    }
    CHECK(
        failures_of(cases, [](const FilmCase& c) -> std::string {
            const SurfaceParams& p = c.p;
            std::string found;
            for (const bool curves : {false, true}) {
                Surface s(p);
                const SurfaceCurves made = curves ? s.make_curves() : SurfaceCurves{};
                if (curves) s.curves = &made;
                const Vec3d a = albedo_of(LobeProbe(s, seen_at(c.cosine), true));
                if (max_component(a) <= 1.012) continue;
                found += fmt::format(
                    "ior {} weight {} roughness {} metal {} glass {} thin {} coat {} {} film {} {} "
                    "{} cosine {} curves {}: {:.4f} {:.4f} {:.4f}\n",
                    p.specular_ior, p.specular_weight, p.specular_roughness, p.base_metalness,
                    p.transmission_weight, p.thin_walled, p.coat_weight, p.coat_ior,
                    p.thin_film_weight, p.thin_film_ior, p.thin_film_thickness, c.cosine, curves,
                    a.x, a.y, a.z);
            }
            return found;
        }) == "");
}
