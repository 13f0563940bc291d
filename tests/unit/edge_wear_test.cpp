// Creases are found by the angle of faces, looked up by distance, and worn by a profile.

#include "materials/nodes/edge_wear.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "renderer/geometry/find_creases.h"
#include "renderer/scene/scene.h"
#include "tests/support/random.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scenes.h"

using namespace tessera;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kRight = 90.0f * kPi / 180.0f, kThirty = 30.0f * kPi / 180.0f;

MeshDesc triangles(std::vector<double> positions, std::vector<std::uint32_t> index) {
    MeshDesc m;
    m.positions = std::move(positions);
    m.position_index = std::move(index);
    m.triangles = static_cast<std::uint32_t>(m.position_index.size() / 3);
    return m;
}

// Triangles anywhere in the unit cube, sharing corners.
MeshDesc tangle(std::uint64_t seed, std::uint32_t corners, std::uint32_t faces) {
    Random r(seed);
    MeshDesc m;
    for (std::uint32_t i = 0; i < 3 * corners; ++i)
        m.positions.push_back(static_cast<double>(r.unit()));
    for (std::uint32_t i = 0; i < 3 * faces; ++i)
        m.position_index.push_back(static_cast<std::uint32_t>(r.bits() % corners));
    m.triangles = faces;
    return m;
}

// A cylinder of this many sides about z, from 0 to 1, of radius 1.
MeshDesc cylinder(std::uint32_t sides) {
    MeshDesc m;
    for (std::uint32_t i = 0; i < sides; ++i)
        for (int z = 0; z < 2; ++z) {
            const double a = 6.283185307179586 * i / sides;
            m.positions.insert(m.positions.end(), {std::cos(a), std::sin(a), double(z)});
        }
    m.positions.insert(m.positions.end(), {0, 0, 0, 0, 0, 1});
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
        m.position_index.insert(m.position_index.end(), {2 * sides, b, a});
        m.position_index.insert(m.position_index.end(), {2 * sides + 1, a + 1, b + 1});
    }
    m.triangles = 2 * sides;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
        m.position_index.insert(m.position_index.end(), {a, b, b + 1, a + 1});
    }
    m.quads = sides;
    return m;
}

// Two faces that meet at the y axis: one lies in the plane z = 0 with its front up, the other falls
// from it by this angle.
MeshDesc bent(double degrees) {
    const double a = degrees * 3.14159265358979 / 180;
    return triangles({-1, 0, 0, 0, -9, 0, 0, 9, 0, std::cos(a), 0, -std::sin(a)},
                     {0, 1, 2, 1, 3, 2});
}

float brute(const std::vector<Crease>& creases, Vec3f p, float reach, float least, bool front) {
    double best = static_cast<double>(reach) * static_cast<double>(reach);
    for (const Crease& c : creases) {
        if ((front ? c.bend : -c.bend) < least) continue;
        const Vec3d a(c.a), b(c.b), q(p);
        const double t = std::clamp(dot(q - a, b - a) / length2(b - a), 0.0, 1.0);
        best = std::min(best, length2(q - a - (b - a) * t));
    }
    return static_cast<float>(std::sqrt(best));
}

}  // namespace

TEST_CASE("creases: a cube has its twelve edges, whose distance is that to the face's border") {
    // Each face of the box has corners of its own.
    const std::vector<Crease> edges = find_creases(box_mesh({0, 0, 0}, 1, 0), kThirty);
    CHECK(edges.size() == 12);
    for (const Crease& c : edges) CHECK(c.bend == doctest::Approx(kRight));
    const CreaseTree tree(edges);
    Random r(31);
    for (int i = 0; i < 500; ++i) {
        const float x = r.between(-1, 1), y = r.between(-1, 1), side = r.unit() < 0.5f ? -1 : 1;
        const float d = 1 - std::max(std::fabs(x), std::fabs(y));
        for (const Vec3f p : {Vec3f{side, x, y}, Vec3f{x, side, y}, Vec3f{x, y, side}}) {
            CHECK(tree.distance(p, 9, kThirty, true) == doctest::Approx(d).epsilon(1e-4));
            CHECK(tree.distance(p, 0.1f, kThirty, true) ==
                  doctest::Approx(std::min(d, 0.1f)).epsilon(1e-4));
            // Seen from inside, a box has no convex edge; and none is sharper than it is.
            CHECK(tree.distance(p, 9, kThirty, false) == 9);
            CHECK(tree.distance(p, 9, kRight + 0.01f, true) == 9);
        }
    }
}

TEST_CASE("creases: a cylinder has those of its caps, and its sides only when they are coarse") {
    CHECK(find_creases(cylinder(32), kThirty).size() == 64);
    CHECK(find_creases(cylinder(8), kThirty).size() == 24);
    for (const Crease& c : find_creases(cylinder(32), kThirty)) {
        CHECK(c.a.z == c.b.z);
        CHECK(c.bend == doctest::Approx(kRight));
    }
}

TEST_CASE("creases: the bend is the faces' angle, below zero where they meet as in a corner") {
    for (const double degrees : {35.0, 90.0, 150.0, 179.5, -35.0, -90.0, -150.0}) {
        const std::vector<Crease> found = find_creases(bent(degrees), kThirty);
        REQUIRE(found.size() == 1);
        CHECK(found[0].bend == doctest::Approx(degrees * 3.14159265358979 / 180).epsilon(1e-5));
        // From behind it is the other way.
        const CreaseTree tree(found);
        const bool front = degrees > 0;
        CHECK(tree.distance({0.1f, 0, 0}, 1, kThirty, front) == doctest::Approx(0.1f));
        CHECK(tree.distance({0.1f, 0, 0}, 1, kThirty, !front) == 1);
    }
    CHECK(find_creases(bent(29), kThirty).empty());
    CHECK(find_creases(bent(0), kThirty).empty());
    // A knife's edge is one from both sides.
    CHECK(find_creases(bent(180), kThirty).size() == 2);
}

TEST_CASE("creases: edges of one face are none, of many the sharpest, of odd winding still one") {
    CHECK(find_creases(triangles({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}), 0.1f).empty());
    // Two boxes that share an edge.
    MeshDesc two = box_mesh({0, 0, 0}, 1, 0);
    const MeshDesc other = box_mesh({2, 2, 0}, 1, 0);
    const auto shift = static_cast<std::uint32_t>(two.positions.size() / 3);
    for (const double x : other.positions) two.positions.push_back(x);
    for (const std::uint32_t i : other.position_index) two.position_index.push_back(i + shift);
    two.quads += other.quads;
    const CreaseTree tree(find_creases(two, kThirty));
    CHECK(tree.distance({1, 0.9f, 0}, 1, kThirty, true) == doctest::Approx(0.1f));
    MeshDesc odd = bent(90);
    std::swap(odd.position_index[3], odd.position_index[4]);
    CHECK(find_creases(odd, kThirty).size() == 1);
}

TEST_CASE("creases: the tree finds the nearest as looking at all of them does") {
    Random r(32);
    for (const std::uint32_t faces : {1u, 2u, 5u, 40u, 700u}) {
        const std::vector<Crease> creases = find_creases(tangle(faces, faces / 2 + 3, faces), 0.2f);
        const CreaseTree tree(creases);
        CHECK(tree.size() == creases.size());
        for (int i = 0; i < 400; ++i) {
            const Vec3f p{r.between(-0.5f, 1.5f), r.unit(), r.unit()};
            const float reach = 2 * r.unit(), least = 3 * r.unit();
            const bool front = r.unit() < 0.5f;
            CHECK(tree.distance(p, reach, least, front) ==
                  doctest::Approx(brute(creases, p, reach, least, front)).epsilon(1e-4));
        }
    }
}

TEST_CASE("creases: meshes that are nothing but mistakes end well") {
    const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
    CHECK(find_creases({}, kThirty).empty());
    CHECK(find_creases(triangles({0, 0, 0, 0, 0, 0, 0, 0, 0}, {0, 1, 2, 0, 0, 0}), 0).empty());
    for (const double x : {inf, -inf, nan, 1e300}) {
        const CreaseTree tree(find_creases(
            triangles({x, 0, 0, 0, -x, 1, 0, 1, 0, x, x, x}, {0, 1, 2, 1, 3, 2, 0, 3, 1}), 0));
        CHECK(tree.distance({0, 0, 0}, 1, 0, true) <= 1);
    }
    // Many faces at one edge.
    MeshDesc fan = triangles({0, 0, 0, 0, 0, 1}, {});
    for (std::uint32_t i = 0; i < 20000; ++i) {
        fan.positions.insert(fan.positions.end(), {std::cos(0.1 * i), std::sin(0.1 * i), 0.5});
        fan.position_index.insert(fan.position_index.end(), {0, 1, i + 2});
    }
    fan.triangles = 20000;
    CHECK(find_creases(fan, 0.01f).size() <= 2);
    const CreaseTree none{{}};
    CHECK(none.distance({}, 3, 0, true) == 3);
}

TEST_CASE("edge wear: 1 on the edge, half at half the width, 0 from there on") {
    const CreaseTree tree({{{0, -9, 0}, {0, 9, 0}, kRight}});
    const auto wear = [&](float x, const EdgeWearParams& e = {.width = 0.5f}) {
        return edge_wear(tree, {x, 0, 0}, e, 0, true);
    };
    CHECK(wear(0) == 1);
    CHECK(wear(0.25f) == doctest::Approx(0.5f));
    CHECK(wear(0.125f) == doctest::Approx(0.84375f));
    CHECK(wear(0.5f) == 0);
    CHECK(wear(7) == 0);
    const EdgeWearParams hard{.width = 0.5f, .contrast = 10};
    CHECK(wear(0.22f, hard) == 1);
    CHECK(wear(0.25f, hard) == doctest::Approx(0.5f));
    CHECK(wear(0.28f, hard) == 0);
    CHECK(wear(0.1f, {.width = 0.5f, .angle_deg = 90}) > 0);
    CHECK(wear(0.1f, {.width = 0.5f, .angle_deg = 91}) == 0);
}

TEST_CASE("edge wear: a footprint sees the mean across a straight edge") {
    const CreaseTree tree({{{0, -99, 0}, {0, 99, 0}, kRight}});
    Random r(33);
    for (int i = 0; i < 60; ++i) {
        const EdgeWearParams e{.width = r.between(0.1f, 1), .contrast = r.between(0, 8)};
        const float x = r.unit(), w = 3 * sqr(r.unit());
        double sum = 0;
        for (int k = 0; k < 4000; ++k)
            sum += static_cast<double>(
                edge_wear(tree, {x + w * ((static_cast<float>(k) + 0.5f) / 4000.0f - 0.5f), 0, 0},
                          e, 0, true));
        // A sum of 4000 points is off by less.
        CHECK(edge_wear(tree, {x, 0, 0}, e, w, true) ==
              doctest::Approx(sum / 4000).epsilon(1e-3).scale(1));
    }
}

TEST_CASE("edge wear: any input gives a value in [0, 1]") {
    constexpr float kHostile[] = {0.0f, -3.7f, 1e-40f, 3e9f, -1e30f, kInfinity, -kInfinity, kNan};
    const CreaseTree tree({{{0, -9, 0}, {0, 9, 0}, kRight}, {{kNan, 0, 0}, {0, 0, 0}, kRight}});
    CHECK(tree.size() == 1);
    for (const float x : kHostile)
        for (const float y : kHostile)
            for (const float z : kHostile) {
                const float a = edge_wear(tree, {x, y, 0}, {.width = z}, 0, true);
                const float b = edge_wear(tree, {0.01f, 0, x}, {y, z, x}, 0.01f, true);
                const float c = edge_wear(tree, {0, x, y}, {}, z, false);
                for (const float wear : {a, b, c}) {
                    CHECK(wear >= 0);
                    CHECK(wear <= 1);
                }
            }
}

namespace {

// A box [-1, 1]^3 whose colour is its wear, alone under a white sky: a pixel's value is the wear.
SceneDesc worn_box(const SceneFolder& folder, const std::string& color) {
    SceneDesc scene = folder.load("[material.worn]\nspecular_weight = 0\nbase_color = " + color);
    scene.meshes.push_back(box_mesh({0, 0, 0}, 1, material_index(scene, "worn")));
    add_sky(scene, {1, 1, 1});
    set_film(scene, 1, 1, 4);
    return scene;
}

Matrix34 scaled(double x, double y, double z, double shift) {
    return {x, 0, 0, shift, 0, y, 0, 0, 0, 0, z, 0};
}

float seen(SceneDesc scene, Double3 from, Double3 at) {
    look_at_point(scene, from, at);
    return beauty_of(std::move(scene))[0];
}

const std::string kWorn = "{ type = 'edgewear', width = 0.5 }";

}  // namespace

TEST_CASE("edge wear: is in the object's own units, placed once or often, scaled or mirrored") {
    const SceneFolder folder;
    const float half = 0.5f;
    SceneDesc once = worn_box(folder, kWorn);
    place(once, ShapeKind::mesh, 0, {scaled(4, 4, 4, 0)});
    // At three quarters of the way out, whatever the scale.
    CHECK(seen(once, {3, 0, 9}, {3, 0, 4}) == doctest::Approx(half).epsilon(1e-3));
    CHECK(seen(once, {1, 0, 9}, {1, 0, 4}) == doctest::Approx(0).epsilon(1e-3));
    SceneDesc often = worn_box(folder, kWorn);
    place(often, ShapeKind::mesh, 0, {scaled(2, 2, 2, 0), scaled(-1, 1, 1, 50)});
    CHECK(seen(often, {1.5, 0, 9}, {1.5, 0, 2}) == doctest::Approx(half).epsilon(1e-3));
    CHECK(seen(often, {50.75, 0, 9}, {50.75, 0, 1}) == doctest::Approx(half).epsilon(1e-3));
    CHECK(seen(often, {50.25, 0, 9}, {50.25, 0, 1}) == doctest::Approx(0).epsilon(1e-3));
}

TEST_CASE("edge wear: creases are collected for materials that ask, by an instance too") {
    const SceneFolder folder;
    const auto creases = [](const SceneDesc& scene) {
        const ScenePtr built = build_scene(SceneDesc(scene), {});
        const CreaseTree& tree = built->geometry().meshes[0].creases;
        CHECK(built->statistics().memory_creases == tree.bytes());
        return tree.size();
    };
    SceneDesc scene = worn_box(folder, kWorn);
    place(scene, ShapeKind::mesh, 0);
    CHECK(creases(scene) == 12);
    const int worn = scene.meshes[0].materials[0];
    scene.meshes[0].materials = {add(scene, matte(0.5f))};
    CHECK(creases(scene) == 0);
    scene.instances[0].material = worn;
    CHECK(creases(scene) == 12);
    SceneDesc sharp = worn_box(folder, "{ type = 'edgewear', angle = 100 }");
    place(sharp, ShapeKind::mesh, 0);
    CHECK(creases(sharp) == 0);
    // An angle that varies takes what it may come to.
    SceneDesc driven = worn_box(folder,
                                "{ type = 'edgewear', angle = { type = 'multiply', in1 = 100, in2 "
                                "= { type = 'random' } } }");
    place(driven, ShapeKind::mesh, 0);
    CHECK(creases(driven) == 12);
    // Spheres have none.
    SceneDesc ball = worn_box(folder, kWorn);
    add_sphere(ball, {0, 0, 0}, 1, worn);
    CHECK(seen(ball, {0, 0, 9}, {0, 0, 0}) == 0);
}

TEST_CASE("edge wear: a corner is worn on the side where it is an edge") {
    const SceneFolder folder;
    SceneDesc scene = worn_box(folder, kWorn);
    MeshDesc corner = bent(-90);
    corner.materials = scene.meshes[0].materials;
    scene.meshes = {corner};
    place(scene, ShapeKind::mesh, 0);
    CHECK(seen(scene, {-0.25, 0, 5}, {-0.25, 0, 0}) == 0);
    CHECK(seen(scene, {-0.25, 0, -5}, {-0.25, 0, 0}) == doctest::Approx(0.5).epsilon(1e-3));
}

TEST_CASE("edge wear: the footprint scales with the object") {
    const SceneFolder folder;
    const auto picture = [&](double scale) {
        SceneDesc scene = worn_box(folder, kWorn);
        place(scene, ShapeKind::mesh, 0, {scaled(scale, scale, scale, 0)});
        look(scene, {0.7 * scale, 0, 5 * scale}, {0.7 * scale, 0, scale});
        scene.camera.projection = Projection::orthographic;
        scene.camera.ortho_height = 0.3 * scale;
        return beauty_of(scene)[0];
    };
    CHECK(picture(16) == doctest::Approx(picture(1)).epsilon(1e-3));
}
