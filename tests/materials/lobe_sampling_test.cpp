// Every lobe that can be sampled by its density: directions against densities, weights against
// values.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/support/lobe_probe.h"
#include "tests/support/parallel_cases.h"
#include "tests/support/sphere_chi_square.h"

using namespace tessera;

namespace {

constexpr double kAlphaOfSuite =
    0.01;  // chance that a right program fails, over all cases of a test case

Vec3f at_degrees(double degrees, double azimuth = 0.4) {
    const double a = degrees * 3.14159265358979 / 180;
    return Vec3f(
        Vec3d{std::sin(a) * std::cos(azimuth), std::sin(a) * std::sin(azimuth), std::cos(a)});
}

struct LobeCase {
    std::string name;
    LobeProbe lobes;
    std::uint64_t seed = 0;
};

template <class Model>
LobeCase one_lobe(std::string name, const Model& model, double degrees) {
    return {fmt::format("{} wo {} deg", name, degrees), LobeProbe(model, at_degrees(degrees))};
}

std::vector<LobeCase> numbered(std::vector<LobeCase> cases) {
    for (std::size_t i = 0; i < cases.size(); ++i) cases[i].seed = 1000 + 17 * i;
    return cases;
}

constexpr double kAngles[] = {0, 30, 60, 80, 89};

std::string chi_square_failure(const LobeCase& c, double level) {
    const auto sample = [&](Random& n) -> std::optional<Vec3d> {
        const Vec2f u = n.pair();
        const auto s = c.lobes.sample(u, n.unit());
        if (!s || s->delta) return std::nullopt;
        return Vec3d(s->wi);
    };
    const auto pdf = [&](Vec3d w) { return static_cast<double>(c.lobes.eval(Vec3f(w)).pdf); };
    SphereTest test;
    test.charts = {{{0, 0, 1}, true}, {{0, 0, -1}, true}};
    test.seed = c.seed;
    const SphereTestResult r = sphere_chi_square_above(level, test, sample, pdf);
    if (!(r.p > level))
        return fmt::format("{}: p = {:.2e} over {} bins (integral {:.5f}, failed {:.5f})", c.name,
                           r.p, r.bins, r.integral, r.failed);
    // The share of failures is known to 4 sigma of its own count.
    const double slack =
        1e-3 + 4 * std::sqrt(std::max(r.failed * (1 - r.failed), 1e-6) / test.samples);
    if (std::fabs(r.integral + r.failed - 1) > slack)
        return fmt::format("{}: the pdf integrates to {:.5f}, {:.5f} failed", c.name, r.integral,
                           r.failed);
    return {};
}

void check_chi_square(const std::vector<LobeCase>& cases) {
    const double level = sidak_level(kAlphaOfSuite, cases.size());
    CHECK(failures_of(cases, [&](const LobeCase& c) { return chi_square_failure(c, level); }) ==
          "");
}

// A sample's weight is value over density of its own direction; its density is eval's.
std::string weight_failure(const LobeCase& c, double tolerance) {
    Random n(c.seed);
    int made = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec2f u = n.pair();
        const auto s = c.lobes.sample(u, n.unit());
        if (!s || s->delta) continue;
        ++made;
        if (std::fabs(length2(Vec3d(s->wi)) - 1) > 1e-5)
            return fmt::format("{}: wi has length {}", c.name, length(Vec3d(s->wi)));
        const LobeEval e = c.lobes.eval(s->wi);
        if (!(e.pdf > 0.0f))
            return fmt::format("{}: a direction was made that has no density", c.name);
        const double pdf = static_cast<double>(e.pdf) / static_cast<double>(s->pdf);
        const double weight = static_cast<double>(e.f.y) / static_cast<double>(e.pdf) /
                              static_cast<double>(s->weight.y);
        if (std::fabs(pdf - 1) > tolerance)
            return fmt::format("{}: eval's pdf is {} times the sample's", c.name, pdf);
        if (s->weight.y > 1e-4f && std::fabs(weight - 1) > tolerance)
            return fmt::format("{}: f/pdf is {} times the weight", c.name, weight);
    }
    return made > 0 ? "" : fmt::format("{}: no sample", c.name);
}

void check_weights(const std::vector<LobeCase>& cases, double tolerance) {
    CHECK(failures_of(cases, [&](const LobeCase& c) { return weight_failure(c, tolerance); }) ==
          "");
}

std::vector<LobeCase> reflection_cases() {
    std::vector<LobeCase> cases{one_lobe("diffuse", DiffuseLobe{}, 0),
                                one_lobe("diffuse", DiffuseLobe{}, 89)};
    for (const float roughness : {0.05f, 0.15f, 0.4f, 0.7f, 1.0f}) {
        for (const float anisotropy : {0.0f, 0.7f}) {
            for (const double angle : kAngles) {
                const RoughReflection<MetalFresnel> metal{
                    openpbr_ggx(roughness, anisotropy), {Color(0.9f), Color(0.8f)}, Color(0.9f)};
                cases.push_back(
                    one_lobe(fmt::format("metal roughness {} anisotropy {}", roughness, anisotropy),
                             metal, angle));
            }
        }
        for (const float eta : {1.05f, 2.5f}) {
            const RoughReflection<DielectricFresnel> coat{
                openpbr_ggx(roughness, 0.7f), {eta}, Color(0.1f)};
            cases.push_back(
                one_lobe(fmt::format("dielectric roughness {} eta {}", roughness, eta), coat, 60));
        }
    }
    return numbered(cases);
}

std::vector<LobeCase> glass_cases() {
    std::vector<LobeCase> cases;
    int turn = 0;
    for (const float roughness : {0.05f, 0.2f, 0.5f, 1.0f}) {
        for (const float ior : {1.05f, 1.5f, 2.5f}) {
            for (const double angle : kAngles) {
                // Isotropic and anisotropic, inside and outside, take turns; each meets each.
                const float anisotropy = ++turn % 2 ? 0.7f : 0.0f;
                const float eta = (turn / 2) % 2 ? ior : 1 / ior;
                cases.push_back(one_lobe(fmt::format("glass roughness {} anisotropy {} eta {:.3f}",
                                                     roughness, anisotropy, eta),
                                         rough_glass(openpbr_ggx(roughness, anisotropy), eta),
                                         angle));
            }
        }
    }
    return numbered(cases);
}

std::vector<LobeCase> layer_cases() {
    std::vector<LobeCase> cases;
    for (const double angle : {0.0, 40.0, 75.0, 88.0}) {
        for (const float roughness : {0.1f, 0.5f, 1.0f}) {
            const std::string at = fmt::format(" roughness {}", roughness);
            cases.push_back(one_lobe("eon" + at, EonLobe{Color(0.7f), roughness}, angle));
            const float cosine = at_degrees(angle).z;
            cases.push_back(one_lobe("fuzz" + at, FuzzLobe::seen_at(cosine, roughness), angle));
            const FilmFresnel film{1.5f, 1.3f, 0.4f, 1.0f, 0.0f};
            cases.push_back(one_lobe(
                "film" + at,
                RoughReflection<FilmFresnel>{openpbr_ggx(roughness, 0.4f), film, Color(0.1f)},
                angle));
            cases.push_back(one_lobe(
                "film on glass" + at,
                RoughGlass<FilmFresnel>{
                    {{film, Color(1.0f), Color(1.0f)}, openpbr_ggx(roughness, 0.0f), 1.0f}},
                angle));
            cases.push_back(one_lobe(
                "sheet" + at,
                RoughSheet<DielectricFresnel>{
                    {{{1.5f}, Color(1.0f), Color(1.0f)}, openpbr_ggx(roughness, 0.4f), 1.0f}},
                angle));
            const Frame tilted(normalize(Vec3f{0.2f, 0.1f, 1.0f}));
            const Vec3f wo = at_degrees(angle);
            if (tilted.to_local(wo).z > 0.0f)
                cases.push_back(
                    one_lobe("coat" + at,
                             Framed<RoughReflection<DielectricFresnel>>{
                                 {openpbr_ggx(roughness, 0.0f), {1.6f}, Color(0.1f)}, tilted},
                             angle));
        }
        cases.push_back(one_lobe("diffuse transmission", DiffuseTransmission{}, angle));
    }
    return numbered(cases);
}

std::vector<LobeCase> surface_cases() {
    std::vector<LobeCase> cases;
    for (const float metalness : {0.0f, 0.4f}) {
        for (const float transmission : {0.0f, 0.6f}) {
            for (const float roughness : {0.0f, 0.3f, 0.8f}) {
                for (const double angle : {5.0, 70.0, 88.0}) {
                    SurfaceParams p;
                    p.base_color = {0.8f, 0.5f, 0.2f};
                    p.base_metalness = metalness;
                    p.transmission_weight = transmission;
                    p.specular_roughness = roughness;
                    p.specular_roughness_anisotropy = 0.3f;
                    p.coat_weight = angle > 50 ? 0.7f : 0.0f;
                    p.coat_roughness = 0.2f;
                    p.fuzz_weight = roughness > 0.5f ? 0.5f : 0.0f;
                    p.base_diffuse_roughness = roughness;
                    LobeCase c;
                    c.name =
                        fmt::format("openpbr metalness {} transmission {} roughness {} wo {} deg",
                                    metalness, transmission, roughness, angle);
                    c.lobes = LobeProbe(p, at_degrees(angle), true);
                    if (c.lobes.has_extended_part()) cases.push_back(c);
                }
            }
        }
    }
    return numbered(cases);
}

}  // namespace

TEST_CASE("reflection lobes: directions are made with the density that eval gives") {
    check_chi_square(reflection_cases());
}
TEST_CASE("layers: directions are made with the density that eval gives") {
    check_chi_square(layer_cases());
}
TEST_CASE("rough glass: directions are made with the density that eval gives") {
    check_chi_square(glass_cases());
}
TEST_CASE("openpbr: directions of all lobes together are made with the density that eval gives") {
    check_chi_square(surface_cases());
}

// The half vector is made once from numbers and once from the directions: at alpha 0.0025 a
// rounding of 1e-7 in it is 1e-4 of the slope.
TEST_CASE("reflection lobes: a sample's weight is value over density") {
    check_weights(reflection_cases(), 2e-3);
}
TEST_CASE("layers: a sample's weight is value over density") { check_weights(layer_cases(), 2e-3); }
TEST_CASE("rough glass: a sample's weight is value over density") {
    check_weights(glass_cases(), 2e-3);
}
TEST_CASE("openpbr: a sample's weight is value over density") {
    check_weights(surface_cases(), 2e-3);
}
