// Scenes that must look the same although they are put together differently, by z-test over blocks
// of pixels.
#include <doctest/doctest.h>

#include "renderer/core/affine.h"
#include "tests/support/picture_statistics.h"

using namespace tessera;

namespace {

constexpr double kAlphaOfSuite = 0.001;
constexpr int kSeeds = 24;

void check_same(const SceneDesc& a, const SceneDesc& b) {
    const BlockStatistics x = block_statistics(a, 100, kSeeds),
                          y = block_statistics(b, 5000, kSeeds);
    CHECK(least_p(x, y) > sidak_level(kAlphaOfSuite, x.values.size()));
}

void check_different(const SceneDesc& a, const SceneDesc& b) {
    const BlockStatistics x = block_statistics(a, 100, kSeeds),
                          y = block_statistics(b, 5000, kSeeds);
    CHECK(least_p(x, y) < 1e-9);
}

// A floor, a quad light and a camera, `at` away from the world's origin.
SceneDesc stage(Double3 at = {0, 0, 0}) {
    const auto p = [&](double x, double y, double z) {
        return Double3{at[0] + x, at[1] + y, at[2] + z};
    };
    SceneDesc s;
    add_mesh(s,
             quad_mesh({p(-3, 0, 3), p(3, 0, 3), p(3, 0, -3), p(-3, 0, -3)}, add(s, matte(0.6f))));
    QuadLightDesc light;
    light.corner = p(-1, 3, -1);
    light.edges = {Double3{1.5, 0, 0}, Double3{0, 0, 1.5}};
    light.radiance = {9, 8, 6};
    add_light(s, light);
    add_sky(s, {0.3f, 0.4f, 0.5f});
    look(s, p(1.5, 2, 4.5), p(0, 0.6, 0));
    set_film(s, 32, 32, 16);
    return s;
}

MeshDesc ramp(int material) {
    // No symmetry: a mirror image or a transposed shear would show.
    MeshDesc mesh = quad_mesh({{0, 0, 0},
                               {1, 0, 0},
                               {1, 0.7, -0.2},
                               {0, 0.3, -0.2},
                               {1, 0, 0},
                               {1, 0, -1},
                               {1, 0.7, -1},
                               {1, 0.7, -0.2},
                               {0, 0.3, -0.2},
                               {1, 0.7, -0.2},
                               {1, 0.7, -1},
                               {0, 0.3, -1},
                               {0, 0, -1},
                               {0, 0, 0},
                               {0, 0.3, -0.2},
                               {0, 0.3, -1}},
                              material);
    return mesh;
}

MeshDesc baked(MeshDesc mesh, const Matrix34& m) {
    const Affined to_world = affine_from_rows(m);
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
        const Vec3d q =
            to_world.point({mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]});
        mesh.positions[i] = q.x, mesh.positions[i + 1] = q.y, mesh.positions[i + 2] = q.z;
    }
    return mesh;
}

}  // namespace

TEST_CASE(
    "instances: mirrored, sheared and stretched copies look like the same meshes baked by hand") {
    const Matrix34 mirrored{-1, 0, 0, -0.3, 0, 1, 0, 0, 0, 0, 1, 0.8},
        sheared{1, 0.6, 0, 0.2, 0.2, 1.4, 0, 0, 0, 0.3, 1, 0.4},
        turned{0, 0, 0.6, 0.5, 0, 0.8, 0, 0, -0.7, 0, 0, 1.8};
    for (const MaterialDesc& material : {matte(0.5f), metal(0.3f, 0.8f)}) {
        SceneDesc instanced = stage(), by_hand = stage();
        const int a = add(instanced, material), b = add(by_hand, material);
        instanced.meshes.push_back(ramp(a));
        place(instanced, ShapeKind::mesh, instanced.meshes.size() - 1, {mirrored, sheared, turned});
        for (const Matrix34& m : {mirrored, sheared, turned}) add_mesh(by_hand, baked(ramp(b), m));
        check_same(instanced, by_hand);
        SceneDesc wrong = instanced;
        wrong.instances.back().transforms[1][1] += 0.3;
        check_different(wrong, by_hand);
    }
}

TEST_CASE("instances: a light carried by instances lights as the baked one does") {
    const Matrix34 left{0.5, 0, 0, -1.2, 0, 0.5, 0, 0.2, 0, 0, 0.5, 0.5},
        right{-0.3, 0.2, 0, 0.9, 0, 0.9, 0, 0.3, 0, 0, 0.4, 0.4};
    SceneDesc instanced = stage(), by_hand = stage();
    instanced.lights.clear();
    by_hand.lights.clear();
    const int a = add(instanced, glowing(4)), b = add(by_hand, glowing(4));
    instanced.meshes.push_back(ramp(a));
    place(instanced, ShapeKind::mesh, instanced.meshes.size() - 1, {left, right});
    for (const Matrix34& m : {left, right}) add_mesh(by_hand, baked(ramp(b), m));
    check_same(instanced, by_hand);
}

TEST_CASE("large coordinates: five million units away the picture is the same") {
    const auto with_things = [](Double3 at) {
        SceneDesc s = stage(at);
        add_sphere(s, {at[0] - 0.8, at[1] + 0.6, at[2] + 0.3}, 0.6, add(s, glass(0)));
        add_mesh(s,
                 box_mesh({at[0] + 0.8, at[1] + 0.5, at[2] + 0.5}, 0.5, add(s, metal(0.4f, 0.7f))));
        without_limits(s, 12);
        return s;
    };
    check_same(with_things({0, 0, 0}), with_things({5e6, 0, -5e6}));
}

TEST_CASE(
    "light and surface sampling: a lamp that only surfaces find lights as one that is aimed at") {
    // The stretch by a millionth makes the lamp an instance, which is not aimed at.
    for (const float roughness : {0.25f, 0.6f}) {
        SceneDesc aimed = stage(), found = stage();
        for (SceneDesc* s : {&aimed, &found}) {
            s->lights.clear();
            s->materials[0] = metal(roughness, 0.8f);
            SphereDesc lamp;
            lamp.center = {0.2, 1.1, 0};
            lamp.radius = 0.7;
            lamp.material = add(*s, glowing(3));
            s->spheres.push_back(lamp);
            s->render.spp = 64;
        }
        place(aimed, ShapeKind::sphere, 0);
        place(found, ShapeKind::sphere, 0, {Matrix34{1.000001, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}});
        check_same(aimed, found);
    }
}
