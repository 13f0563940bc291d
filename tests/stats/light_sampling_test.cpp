// Every kind of light: the directions toward it against the densities that multiple importance
// sampling is told.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <functional>

#include "renderer/scene/scene.h"
#include "tests/support/parallel_cases.h"
#include "tests/support/sphere_chi_square.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr double kAlphaOfSuite = 0.01;
constexpr double kPiD = 3.14159265358979323846;

struct LightCase {
    std::string name;
    std::shared_ptr<const Light> light;
    Vec3f ref;
    Vec3d axis;                        // toward the light
    std::function<double(Vec3d)> pdf;  // what light_pdf says of the points along a direction
    Vec3d across{0, 0, 0};  // flat lights: a pole beside which they are a patch, not a ring
};

double claimed(const Light& light, Vec3f ref, Vec3d w, double t, Vec3d n,
               std::int32_t material = -1) {
    if (!(t > 0)) return 0;
    return static_cast<double>(
        light_pdf(light, {ref}, Vec3f(w), Vec3f(Vec3d(ref) + w * t), Vec3f(n), material));
}

LightCase quad_case(std::string name, const QuadLight& q, Vec3f ref) {
    LightCase c{std::move(name), std::make_shared<Light>(q), ref, {}, {}, Vec3d{0.01, 1, 0.02}};
    c.axis = Vec3d(q.corner + (q.edge_u + q.edge_v) * 0.5f - ref);
    c.pdf = [q, ref, light = c.light](Vec3d w) {
        const Vec3d n = cross(Vec3d(q.edge_u), Vec3d(q.edge_v));
        const double t = dot(Vec3d(q.corner - ref), n) / dot(w, n);
        const Vec3d d = Vec3d(ref) + w * t - Vec3d(q.corner);
        // Coordinates along two edges that need not be perpendicular.
        const double u = dot(cross(d, Vec3d(q.edge_v)), n) / length2(n),
                     v = dot(cross(Vec3d(q.edge_u), d), n) / length2(n);
        return u >= 0 && u <= 1 && v >= 0 && v <= 1 ? claimed(*light, ref, w, t, normalize(n))
                                                    : 0.0;
    };
    return c;
}

LightCase disc_case(std::string name, const DiscLight& l, Vec3f ref) {
    LightCase c{std::move(name), std::make_shared<Light>(l), ref, Vec3d(l.center - ref), {},
                Vec3d(l.normal)};
    c.pdf = [l, ref, light = c.light](Vec3d w) {
        const Vec3d n(l.normal);
        const double t = dot(Vec3d(l.center - ref), n) / dot(w, n);
        return length(Vec3d(ref) + w * t - Vec3d(l.center)) <= static_cast<double>(l.radius)
                   ? claimed(*light, ref, w, t, n)
                   : 0.0;
    };
    return c;
}

LightCase sphere_case(std::string name, const SphereLight& l, Vec3f ref) {
    LightCase c{std::move(name),
                std::make_shared<Light>(l),
                ref,
                Vec3d(l.center - ref) + Vec3d{0, 1e-4, 0},
                {}};
    c.pdf = [l, ref, light = c.light](Vec3d w) {
        const Vec3d to(l.center - ref);
        const double r = static_cast<double>(l.radius), middle = dot(to, w),
                     half2 = r * r - length2(to - w * middle);
        if (half2 < 0) return 0.0;
        const double half = std::sqrt(half2);
        const bool by_cone = length2(to) > 1.0002 * r * r;
        double sum = 0;
        for (const double t : {middle - half, middle + half}) {
            sum += claimed(*light, ref, w, t, normalize(w * t - to));
            if (by_cone && sum > 0) break;  // the far side is no target of its own
        }
        return sum;
    };
    return c;
}

QuadLight make_quad(Vec3f corner, Vec3f u, Vec3f v) {
    return make_quad_light(Vec3d(corner), Vec3d(u), Vec3d(v), Color(1.0f), true);
}

// The mesh light of a scene, two materials of unlike brightness, as the scene's builder makes it.
// place: beside the mesh itself, which makes both of them instances; the light is that of `place`.
LightCase mesh_case(std::string name, Vec3f ref,
                    const std::optional<Matrix34>& place_at = std::nullopt) {
    SceneDesc scene;
    const int dim = add(scene, glowing(1)), bright = add(scene, glowing(7));
    MeshDesc mesh = quad_mesh({{-1, 2, 0},
                               {1, 2, 0},
                               {1, 3, 0.5},
                               {-1, 3, 0.5},
                               {-1, 2, 1},
                               {0, 2, 1},
                               {0, 2.5, 1},
                               {-1, 2.2, 1}},
                              dim);
    mesh.materials = {dim, bright};
    mesh.face_material = {0, 1};
    add_mesh(scene, mesh);
    if (place_at) scene.instances[0].transforms = {*place_at, kIdentity34};
    const ScenePtr built = build_scene(std::move(scene));
    LightCase c{std::move(name),
                std::make_shared<Light>(built->lights()[0]),
                ref,
                Vec3d{0, 2.4, 0.5} - Vec3d(ref),
                {},
                Vec3d{0.01, 0.2, 1}};
    const auto& mesh_light = std::get<MeshLight>(*c.light);
    REQUIRE(mesh_light.placed == place_at.has_value());
    if (place_at) c.axis = Affined(mesh_light.to_world).point({0, 2.4, 0.5}) - Vec3d(ref);
    c.pdf = [ref, light = c.light](Vec3d w) {
        double sum = 0;
        const auto& l = std::get<MeshLight>(*light);
        const Affined m = l.placed ? Affined(l.to_world) : Affined();
        for (const auto& t : l.faces->triangles) {
            const Vec3d ab = m.vector(Vec3d(t.ab)), ac = m.vector(Vec3d(t.ac)), n = cross(ab, ac);
            const Vec3d a = m.point(Vec3d(t.a));
            const double along = dot(a - Vec3d(ref), n) / dot(w, n);
            const Vec3d d = Vec3d(ref) + w * along - a;
            const double u = dot(cross(d, ac), n) / length2(n),
                         v = dot(cross(ab, d), n) / length2(n);
            if (u >= 0 && v >= 0 && u + v <= 1)
                sum += claimed(*light, ref, w, along, normalize(n), t.material);
        }
        return sum;
    };
    return c;
}

LightCase sky_case(std::string name, const EnvironmentLight& e, Vec3d axis) {
    LightCase c{std::move(name), std::make_shared<Light>(e), {}, axis, {}};
    c.pdf = [light = c.light](Vec3d w) {
        return static_cast<double>(std::get<EnvironmentLight>(*light).look(Vec3f(w)).pdf);
    };
    return c;
}

EnvironmentLight hot_pixel(int width, int height, float heat, double rotate_deg) {
    std::vector<Color> texels;
    Random n(3);
    for (int i = 0; i < width * height; ++i) texels.push_back(Color(n.between(0.0f, 1.0f)));
    texels[std::size_t(height / 3 * width + width / 4)] = Color(heat);
    for (int x = 0; x < width / 2; ++x) texels[std::size_t(height / 2 * width + x)] = Color(0.0f);
    return make_environment(width, height, std::move(texels), Color(2.0f), rotate_deg, true);
}

LightCase distant_case(double angle_deg) {
    SceneDesc scene;
    add_light(scene, DistantLightDesc{{0.3, -1, 0.2}, {1, 1, 1}, angle_deg});
    const ScenePtr built = build_scene(std::move(scene));
    LightCase c{fmt::format("distant {} deg", angle_deg),
                std::make_shared<Light>(built->lights()[0]),
                {},
                {-0.3, 1, -0.2},
                {}};
    const double half = angle_deg * kPiD / 360,
                 solid_angle = 4 * kPiD * std::pow(std::sin(half / 2), 2);
    c.pdf = [half, solid_angle, axis = normalize(c.axis)](Vec3d w) {
        return std::atan2(length(cross(w, axis)), dot(w, axis)) < half ? 1 / solid_angle : 0.0;
    };
    return c;
}

std::vector<LightCase> all_lights() {
    const QuadLight square = make_quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}),
                    slant = make_quad({-1, 3, -1}, {2, 0.3f, 0}, {0.5f, 0, 2});
    const QuadLight strip = make_quad({-4, 1, -0.05f}, {8, 0, 0}, {0, 0, 0.1f});
    const DiscLight disc{{0, 3, 0}, normalize(Vec3f{0.2f, -1, 0.1f}), 0.8f, Color(1.0f), true};
    const SphereLight ball{{0, 3, 0}, 0.7f, Color(1.0f)};
    EnvironmentLight even =
        make_environment(8, 4, std::vector<Color>(32, Color(1.0f)), Color(1.0f), 0, true);
    return {quad_case("rectangle near, by solid angle", square, {0.2f, 1, 0.3f}),
            quad_case("rectangle very near", square, {0.9f, 2.9f, 0.3f}),
            quad_case("rectangle nearly touched", square, {0.3f, 2.99f, 0.1f}),
            quad_case("rectangle beside", square, {3, 2.5f, 0}),
            quad_case("rectangle far, by area", square, {5, -20, 3}),
            quad_case("rectangle at grazing angle", square, {6, 2.9f, 0.5f}),
            quad_case("parallelogram near", slant, {0.2f, 1, 0.3f}),
            quad_case("parallelogram far", slant, {9, -9, 3}),
            quad_case("strip near", strip, {0.5f, 0.5f, 0.2f}),
            quad_case("rectangle from behind", square, {0.2f, 5, 0.3f}),
            disc_case("disc near", disc, {0.3f, 2, 0}),
            disc_case("disc far", disc, {4, -20, 3}),
            disc_case("disc at grazing angle", disc, {4, 2.7f, 0}),
            sphere_case("sphere near", ball, {0.3f, 2.2f, 0}),
            sphere_case("sphere far", ball, {40, -100, 20}),
            sphere_case("sphere very far", ball, {3000, -100, 20}),
            sphere_case("sphere from inside", ball, {0.1f, 2.8f, 0.3f}),
            mesh_case("mesh near", {0.3f, 1, 0.4f}),
            mesh_case("mesh far", {10, -30, 15}),
            mesh_case("mesh from behind", {0.3f, 3, -3}),
            mesh_case("mesh sheared and mirrored", {0.3f, 1, 0.4f},
                      Matrix34{-0.7, 0.4, 0.1, 0.2, 0, 1.1, 0.3, 0.5, 0.2, -0.1, 0.6, 0.1}),
            mesh_case("mesh flattened", {0.3f, 1, 0.4f},
                      Matrix34{1, 0, 0, 0, 0, 0.2, 0, 2, 0, 0, 1, 0}),
            sky_case("sky constant", make_constant_environment(Color(1.0f), true), {0, 1, 0}),
            sky_case("sky image, even", even, {0, 1, 0}),
            sky_case("sky image, hot texel", hot_pixel(32, 16, 500, 40), {0.3, 0.5, -0.6}),
            sky_case("sky image, very hot texel", hot_pixel(32, 16, 1e6f, 0), {-1, 0.5, 0}),
            distant_case(0.53),
            distant_case(20)};
}

std::string chi_square_failure(const LightCase& c, double level) {
    SphereTest test;
    const Vec3d toward = normalize(c.axis), pole = c.across - toward * dot(c.across, toward);
    test.charts = {length2(pole) > 0 ? SphereChart{pole, false, toward}
                                     : SphereChart{c.axis, false, {}}};
    test.seed = 99;
    const SphereTestResult r = sphere_chi_square_above(
        level, test,
        [&](Random& n) -> std::optional<Vec3d> {
            LightSample s;
            if (!sample_light(*c.light, {c.ref}, n.pair(), s)) return std::nullopt;
            return Vec3d(s.wi);
        },
        c.pdf);
    if (!(r.p > level))
        return fmt::format("{}: p = {:.2e} over {} bins (integral {:.5f}, failed {:.5f})", c.name,
                           r.p, r.bins, r.integral, r.failed);
    return std::fabs(r.integral + r.failed - 1) < 1e-3
               ? ""
               : fmt::format("{}: the pdf integrates to {:.5f}, {:.5f} failed", c.name, r.integral,
                             r.failed);
}

// The parts of a sample agree: the point lies along wi, the density is light_pdf's at that point.
std::string sample_failure(const LightCase& c) {
    Random n(4);
    for (int i = 0; i < 5000; ++i) {
        LightSample s;
        if (!sample_light(*c.light, {c.ref}, n.pair(), s)) continue;
        if (std::fabs(length2(Vec3d(s.wi)) - 1) > 1e-5)
            return c.name + ": wi is not of unit length";
        if (!(s.pdf > 0.0f)) return c.name + ": a sample has no density";
        const double dense = c.pdf(Vec3d(s.wi));
        if (s.infinite) {
            if (dense > 0 && std::fabs(dense / static_cast<double>(s.pdf) - 1) > 1e-3)
                return fmt::format("{}: pdf {} and {}", c.name, dense, s.pdf);
            continue;
        }
        const Vec3d to = Vec3d(s.p - c.ref);
        // A point nearer than a hundredth of the light's size has its direction from fewer digits.
        if (length(normalize(to) - Vec3d(s.wi)) > 2e-4)
            return fmt::format("{}: p does not lie along wi ({:.2e})", c.name,
                               length(normalize(to) - Vec3d(s.wi)));
        if (std::fabs(length2(Vec3d(s.n)) - 1) > 1e-5) return c.name + ": n is not of unit length";
        const double again =
            static_cast<double>(light_pdf(*c.light, {c.ref}, s.wi, s.p, s.n, s.material));
        if (std::fabs(again / static_cast<double>(s.pdf) - 1) > 2e-3)
            return fmt::format("{}: sample pdf {}, light_pdf {}", c.name, s.pdf, again);
    }
    return {};
}

// Sixteen samples of a light set.
struct Drawn {
    SamplePairs u;
    float choice[kLanes];
    LightSamples samples;
    LaneMask made = 0;

    LightSample sample(int lane) const {
        LightSample s;
        s.wi = samples.wi[lane], s.pdf = samples.pdf[lane];
        s.radiance = samples.radiance[lane];
        s.delta = samples.delta[lane] != 0, s.infinite = samples.infinite[lane] != 0;
        s.material = samples.material[lane];
        if (!s.infinite)
            s.p = samples.p[lane], s.p_error = samples.p_error[lane], s.n = samples.n[lane];
        return s;
    }
};

Drawn draw(const LightSet& set, Vec3f ref, Random& n, LaneMask lanes = kAllLanes) {
    Drawn d;
    LightReference refs[kLanes];
    for (int i = 0; i < kLanes; ++i) {
        refs[i] = {ref};
        d.choice[i] = n.unit();
        const Vec2f u = n.pair();
        d.u.x[i] = u.x, d.u.y[i] = u.y;
    }
    d.made = set.sample(lanes, refs, d.choice, d.u, d.samples);
    return d;
}

}  // namespace

TEST_CASE("light set: a lane's sample is sample_light's, whichever lanes are asked for with it") {
    std::vector<Light> lights;
    for (const LightCase& c : all_lights())
        if (!c.name.starts_with("sky constant")) lights.push_back(*c.light);
    const LightSet set(lights, std::vector<double>(lights.size(), 1.0));
    const Vec3f ref{0.15f, 0.9f, 0.25f};
    for (int i = 0; i < 2000; ++i) {
        Random again(static_cast<std::uint64_t>(i)), n(static_cast<std::uint64_t>(i));
        const Drawn all = draw(set, ref, n);
        const auto lanes = static_cast<LaneMask>((i * 2654435761u) >> 16) & kAllLanes;
        const Drawn some = draw(set, ref, again, lanes);
        REQUIRE(some.made == (all.made & lanes));
        for (int lane = 0; lane < kLanes; ++lane) {
            if (((some.made >> lane) & 1u) == 0) continue;
            const LightSample a = all.sample(lane), b = some.sample(lane);
            REQUIRE(a.wi == b.wi);
            REQUIRE(a.pdf == b.pdf);
            REQUIRE(a.radiance == b.radiance);
            // One of the lights gives it by itself.
            bool found = false;
            for (const Light& light : lights) {
                LightSample own;
                found |= sample_light(light, {ref}, all.u.at(lane), own) && own.wi == a.wi &&
                         own.radiance == a.radiance && own.p == a.p && own.n == a.n;
            }
            REQUIRE(found);
        }
    }
}

TEST_CASE("environment: sixteen look-ups are look()'s") {
    const EnvironmentLight sky = hot_pixel(32, 16, 500, 40);
    Random n(12);
    for (int i = 0; i < 1000; ++i) {
        Vec3Lanes d;
        for (int lane = 0; lane < kLanes; ++lane) d.set(lane, Vec3f(n.direction()));
        EnvironmentLight::Look seen[kLanes];
        sky.look(0x5555u, d, seen);
        for (int lane = 0; lane < kLanes; lane += 2) {
            const EnvironmentLight::Look one = sky.look(d[lane]);
            REQUIRE(seen[lane].radiance == one.radiance);
            REQUIRE(seen[lane].pdf == one.pdf);
        }
    }
}

TEST_CASE(
    "lights: directions are made with the density that light_pdf gives, which integrates to one") {
    const auto cases = all_lights();
    const double level = sidak_level(kAlphaOfSuite, cases.size());
    CHECK(failures_of(cases, [&](const LightCase& c) { return chi_square_failure(c, level); }) ==
          "");
}

TEST_CASE("lights: point, direction, normal and density of a sample agree") {
    CHECK(failures_of(all_lights(), sample_failure) == "");
}

TEST_CASE("light set: the density of a sample includes the choice of the light") {
    std::vector<Light> lights;
    std::vector<double> powers;
    for (const LightCase& c : all_lights()) {
        if (std::holds_alternative<EnvironmentLight>(*c.light) ||
            std::holds_alternative<DistantLight>(*c.light))
            continue;
        lights.push_back(*c.light);
        powers.push_back(static_cast<double>(lights.size() % 5));  // some are never chosen
    }
    const LightSet set(lights, powers);
    const Vec3f ref{0.15f, 0.9f, 0.25f};
    Random n(6);
    std::vector<double> chosen(lights.size());
    constexpr int kTries = 200000;
    int made = 0;
    for (int i = 0; i < kTries; i += kLanes) {
        const Drawn drawn = draw(set, ref, n);
        for (int lane = 0; lane < kLanes; ++lane) {
            if (((drawn.made >> lane) & 1u) == 0) continue;
            const LightSample s = drawn.sample(lane);
            ++made;
            // Which light was it? The one that gives this very sample for the same numbers.
            for (std::size_t l = 0; l < lights.size(); ++l) {
                LightSample own;
                if (!sample_light(lights[l], {ref}, drawn.u.at(lane), own) || !(own.p == s.p))
                    continue;
                const auto index = static_cast<int>(l);
                const double claimed_pdf =
                    static_cast<double>(set.pdf(index, {ref}, s.wi, s.p, s.n, s.material));
                if (claimed_pdf > 0 &&
                    std::fabs(claimed_pdf / static_cast<double>(s.pdf) - 1) < 2e-3) {
                    ++chosen[l];
                    break;
                }
            }
        }
    }
    double found = 0;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        found += chosen[l];
        if (powers[l] == 0) CHECK(chosen[l] == 0);
    }
    CHECK(made > kTries / 2);
    CHECK(found == made);
}

TEST_CASE("light set: the estimate of all light is the sum over the lights") {
    // The mean of radiance cos / pdf over chosen lights against that over each light by itself; 4.5
    // sigma.
    std::vector<Light> lights;
    std::vector<double> powers;
    for (const LightCase& c : all_lights()) {
        if (c.name == "rectangle near, by solid angle" || c.name == "disc near" ||
            c.name == "sphere near" || c.name == "sky image, hot texel") {
            lights.push_back(*c.light);
            powers.push_back(light_power(*c.light, 5));
        }
    }
    lights.push_back(PointLight{{1, 2, 3}, Color(4.0f)});
    powers.push_back(light_power(lights.back(), 5));
    const LightSet set(lights, powers);
    const Vec3f ref{0.15f, 0.9f, 0.25f};
    const auto received = [](const LightSample& s) {
        return std::max(0.0, static_cast<double>(s.wi.y)) * static_cast<double>(s.radiance.x) /
               static_cast<double>(s.pdf);
    };
    Random n(8);
    Mean together;
    std::vector<Mean> apart(lights.size());
    for (int i = 0; i < 400000; i += kLanes) {
        const Drawn drawn = draw(set, ref, n);
        for (int lane = 0; lane < kLanes; ++lane) {
            together.add(((drawn.made >> lane) & 1u) != 0 ? received(drawn.sample(lane)) : 0);
            for (std::size_t l = 0; l < lights.size(); ++l) {
                LightSample own;
                apart[l].add(sample_light(lights[l], {ref}, n.pair(), own) ? received(own) : 0);
            }
        }
    }
    double sum = 0, variance = together.error() * together.error();
    for (const Mean& m : apart) sum += m.mean(), variance += m.error() * m.error();
    CHECK(std::fabs(together.mean() - sum) < 4.5 * std::sqrt(variance));
    CHECK(together.error() < 0.02 * sum);
}
