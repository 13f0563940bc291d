// The white furnace: surfaces in uniform light give back no more than they get.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "materials/energy.h"
#include "renderer/core/sampler.h"
#include "tests/support/lobe_probe.h"
#include "tests/support/parallel_cases.h"

using namespace tessera;

namespace {

Vec3f seen_at(float cosine) { return {safe_sqrt(1 - cosine * cosine), 0, cosine}; }

// Energy sent to all directions from wo, of the channel that gets most: radiance's 1/eta^2 at a
// boundary is taken back. Error below 1e-3: 2^13 stratified points of weights between zero and one.
double albedo_of(const LobeProbe& lobes) {
    constexpr std::uint32_t kPoints = 1u << 13;
    Vec3d sum;
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        const auto s = lobes.sample(sample_pair(77, i, 0), sample_pair(77, i, 1).x);
        if (s) sum += Vec3d(s->weight) * static_cast<double>(s->eta * s->eta);
    }
    return max_component(sum) / kPoints;
}

struct FurnaceCase {
    SurfaceParams p;
    float cosine;
    bool front;
    std::string name() const {
        return fmt::format(
            "metalness {} specular_weight {} roughness {} diffuse {} transmission {} ior {} thin "
            "{} "
            "coat {} {} fuzz {} film {} subsurface {} cosine {} {}",
            p.base_metalness, p.specular_weight, p.specular_roughness, p.base_diffuse_roughness,
            p.transmission_weight, p.specular_ior, p.thin_walled, p.coat_weight, p.coat_roughness,
            p.fuzz_weight, p.thin_film_weight, p.subsurface_weight, cosine,
            front ? "front" : "back");
    }
};

SurfaceParams white() {
    SurfaceParams p;
    p.base_color = p.subsurface_color = Color(1.0f);
    return p;
}

std::vector<FurnaceCase> bases() {
    std::vector<FurnaceCase> cases;
    for (const float metalness : {0.0f, 0.5f, 1.0f}) {
        for (const float weight : {0.0f, 0.5f, 1.0f}) {
            for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
                for (const float transmission : {0.0f, 0.5f, 1.0f}) {
                    for (const float ior : {1.0f, 1.2f, 1.5f, 2.5f}) {
                        for (const float cosine : {1.0f, 0.7f, 0.3f, 0.05f}) {
                            for (const int side : {0, 1, 2}) {
                                if (metalness == 1.0f &&
                                    (transmission > 0.0f || ior != 1.5f || side > 0))
                                    continue;
                                SurfaceParams p = white();
                                p.base_metalness = metalness;
                                p.specular_weight = weight;
                                p.specular_roughness = roughness;
                                p.transmission_weight = transmission;
                                p.specular_ior = ior;
                                p.thin_walled = side == 2;
                                cases.push_back({p, cosine, side != 1});
                            }
                        }
                    }
                }
            }
        }
    }
    return cases;
}

std::vector<FurnaceCase> layered() {
    std::vector<FurnaceCase> cases;
    const auto add = [&](SurfaceParams p, auto change) {
        change(p);
        for (const float cosine : {1.0f, 0.6f, 0.2f, 0.04f}) {
            cases.push_back({p, cosine, true});
            if (p.transmission_weight > 0.0f) cases.push_back({p, cosine, false});
        }
    };
    for (const int base : {0, 1, 2, 3, 4}) {
        SurfaceParams p = white();
        p.base_metalness = base == 1 ? 1.0f : 0.0f;
        p.transmission_weight = base == 2 ? 1.0f : 0.0f;
        p.base_diffuse_roughness = base == 3 ? 1.0f : 0.0f;
        p.subsurface_weight = base == 4 ? 0.7f : 0.0f;
        p.thin_walled = base == 4;
        for (const float roughness : {0.0f, 0.4f, 1.0f}) {
            p.specular_roughness = roughness;
            add(p, [](SurfaceParams&) {});
            for (const float coat_roughness : {0.0f, 0.3f, 1.0f})
                add(p, [&](SurfaceParams& c) {
                    c.coat_weight = 1, c.coat_roughness = coat_roughness;
                });
            add(p, [](SurfaceParams& c) { c.fuzz_weight = 1, c.fuzz_roughness = 0.2f; });
            add(p, [](SurfaceParams& c) { c.fuzz_weight = 0.5f, c.coat_weight = 0.5f; });
            for (const float thickness : {0.0f, 0.1f, 0.35f, 0.8f})
                add(p, [&](SurfaceParams& c) {
                    c.thin_film_weight = 1, c.thin_film_thickness = thickness;
                });
        }
    }
    return cases;
}

struct Albedos {
    double by_table, by_curve;
};

// A material whose boundaries do not vary has curves in place of the tables.
Albedos albedos_of(const FurnaceCase& c) {
    Surface s(c.p);
    const Vec3f wo = seen_at(c.cosine);
    const double by_table = albedo_of(LobeProbe(s, wo, c.front));
    const SurfaceCurves curves = s.make_curves();
    s.curves = &curves;
    return {by_table, albedo_of(LobeProbe(s, wo, c.front))};
}

// Cases that give back more than 1 + slack, or, if all is to come back, less than 1 - slack.
std::string failures(const std::vector<FurnaceCase>& cases, double slack, bool all) {
    return failures_of(cases, [&](const FurnaceCase& c) -> std::string {
        const auto [by_table, by_curve] = albedos_of(c);
        const double most = std::max(by_table, by_curve), least = std::min(by_table, by_curve);
        if (most <= 1 + slack && (!all || least >= 1 - slack)) return "";
        return fmt::format("{}: table {:.5f} curve {:.5f}", c.name(), by_table, by_curve);
    });
}

}  // namespace

// 0.012: what a layer lets through and what a rough boundary loses come from tables good to 0.01.
TEST_CASE("furnace: no base of openpbr gives back more light than it gets") {
    CHECK(failures(bases(), 0.012, false) == "");
}

TEST_CASE("furnace: no layers of openpbr give back more light than they get") {
    CHECK(failures(layered(), 0.012, false) == "");
}

TEST_CASE("furnace: white surfaces give back everything, however rough") {
    std::vector<FurnaceCase> cases;
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
        for (const float cosine : {1.0f, 0.7f, 0.3f, 0.1f}) {
            const auto add = [&](auto change, bool front = true) {
                SurfaceParams p = white();
                p.specular_roughness = roughness;
                change(p);
                cases.push_back({p, cosine, front});
            };
            add([](SurfaceParams& p) { p.specular_weight = 0; });
            add([&](SurfaceParams& p) {
                p.specular_weight = 0, p.base_diffuse_roughness = roughness;
            });
            add([](SurfaceParams& p) { p.base_metalness = 1; });
            add([](SurfaceParams&) {});
            for (const bool front : {true, false})
                add([](SurfaceParams& p) { p.transmission_weight = 1; }, front);
            add([](SurfaceParams& p) { p.transmission_weight = 1, p.thin_walled = true; });
            add([](SurfaceParams& p) { p.subsurface_weight = 1, p.thin_walled = true; });
            add([&](SurfaceParams& p) { p.coat_weight = 1, p.coat_roughness = roughness; });
            add([](SurfaceParams& p) { p.fuzz_weight = 1; });
        }
    }
    CHECK(failures(cases, 0.012, true) == "");
}

TEST_CASE("furnace: stretched highlights lose a little and make nothing") {
    std::vector<FurnaceCase> cases;
    for (const float roughness : {0.2f, 0.4f, 0.6f, 0.8f, 1.0f}) {
        for (const float anisotropy : {0.3f, 0.6f, 0.85f, 1.0f}) {
            for (const float cosine : {1.0f, 0.7f, 0.3f, 0.1f}) {
                for (const int base : {0, 1, 2}) {
                    SurfaceParams p = white();
                    p.base_metalness = base == 1 ? 1.0f : 0.0f;
                    p.transmission_weight = base == 2 ? 1.0f : 0.0f;
                    p.specular_roughness = roughness;
                    p.specular_roughness_anisotropy = anisotropy;
                    cases.push_back({p, cosine, true});
                }
            }
        }
    }
    CHECK(failures(cases, 0.012, false) == "");
}

TEST_CASE(
    "furnace: white Lambert, smooth glass and a perfect mirror give back everything exactly") {
    for (const float cosine : {1.0f, 0.5f, 0.05f}) {
        const auto albedo = [&](auto change, bool front = true) {
            SurfaceParams p = white();
            p.specular_roughness = 0;
            change(p);
            return albedo_of(LobeProbe(p, seen_at(cosine), front));
        };
        const auto one = doctest::Approx(1).epsilon(1e-6);
        CHECK(albedo([](SurfaceParams& p) { p.specular_weight = 0; }) == one);
        CHECK(albedo([](SurfaceParams& p) { p.base_metalness = 1; }) == one);
        for (const bool front : {true, false})
            CHECK(albedo([](SurfaceParams& p) { p.transmission_weight = 1; }, front) == one);
        // A smooth layered plastic: boundary and base share without loss.
        CHECK(albedo([](SurfaceParams&) {}) == doctest::Approx(1).epsilon(2e-3));
    }
}

TEST_CASE("coat: it darkens what lies below by its internal reflection, and a full one tints it") {
    SurfaceParams p = white();
    p.base_color = Color(0.5f);
    p.specular_weight = 0;
    const auto albedo = [&] { return albedo_of(LobeProbe(p, seen_at(1), true)); };
    p.coat_weight = 1;
    p.coat_darkening = 0;
    // Fresnel's 0.0533 of the coat, and half of the rest.
    CHECK(albedo() == doctest::Approx(0.0533 + 0.9467 * 0.5).epsilon(5e-3));
    p.coat_darkening = 1;
    const double dark = albedo();
    // 1 - (1 - 0.1087) / 1.6^2 = 0.652 of what comes up is thrown back.
    CHECK(dark == doctest::Approx(0.0533 + 0.9467 * 0.5 * 0.348 / (1 - 0.326)).epsilon(1e-2));
    p.coat_color = Color(0.5f);
    CHECK(albedo() == doctest::Approx(0.0533 + 0.5 * (dark - 0.0533)).epsilon(1e-2));
}

TEST_CASE("energy: the tables agree with fine quadrature to 0.01") {
    struct At {
        float cosine, alpha, eta;
    };
    std::vector<At> points;
    Vec2f u;
    for (std::uint32_t i = 0; i < 300; ++i) {
        u = sample_pair(3, i, 0);
        points.push_back({std::fmax(i % 2 ? u.x : u.x * u.x, 0.005f), std::fmax(u.y, 0.001f),
                          1.01f + 2.0f * sample_pair(3, i, 1).x});
    }
    const auto check = [](const At& a) -> std::string {
        const auto differ = [&](const char* what, float table, float fine) {
            return std::fabs(fine - table) < 0.01f
                       ? std::string()
                       : fmt::format("{} cos {} alpha {} eta {}: table {} quadrature {}\n", what,
                                     a.cosine, a.alpha, a.eta, table, fine);
        };
        const float c = a.cosine, r = a.alpha, e = a.eta;
        return differ("dielectric", dielectric_reflection_albedo(c, r, e),
                      dielectric_reflection_albedo_quadrature(c, r, e, 200)) +
               differ("mirror", mirror_albedo(c, r), mirror_albedo_quadrature(c, r, 200)) +
               differ("into glass", glass_albedo(c, r, e), glass_albedo_quadrature(c, r, e, 200)) +
               differ("out of glass", glass_albedo(c, r, 1 / e),
                      glass_albedo_quadrature(c, r, 1 / e, 200));
    };
    CHECK(failures_of(points, check) == "");
}
