#include "materials/relief.h"

#include <doctest/doctest.h>

#include <cmath>

#include "materials/program.h"
#include "materials/terminator.h"
#include "renderer/geometry/interpolate.h"
#include "tests/support/scene_folder.h"

namespace tessera::test {
namespace {

bool near(Vec3f a, Vec3f b, float slack = 1e-5f) { return max_component(abs(a - b)) <= slack; }

// A point of the plane z = 0, charted with u along x, v along `v_axis`, looked at from above.
ShadeInput on_plane(Vec3f p = {}, Vec3f v_axis = {0, 1, 0}) {
    ShadeInput in;
    in.p_object = in.p_world = p;
    in.n = {0, 0, 1};
    in.p_width = 1e-2f;
    in.dpdu = {1, 0, 0};
    in.dpdv = v_axis;
    return in;
}

ShaderProgram program_of(const std::string& keys) {
    const SceneFolder folder;
    return ShaderProgram(folder.load("[material.a]\n" + keys).materials.front());
}

}  // namespace

TEST_CASE("relief: a bump's normal is that of the height field, whatever the chart") {
    // h = 0.3 x + 0.2 y: the surface's normal is (-0.3, -0.2, 1), exactly.
    const Vec3f expected = normalize(Vec3f{-0.3f, -0.2f, 1});
    const auto height = [](const ShadeInput& at) {
        return 0.3f * at.p_world.x + 0.2f * at.p_world.y;
    };
    for (const Vec3f v_axis : {Vec3f{0, 1, 0}, Vec3f{0, -2, 0}, Vec3f{0.7f, 0.4f, 0}}) {
        const ShadeInput in = on_plane({}, v_axis);
        CHECK(near(bumped_normal(in.n, in, object_unit(in), height), expected, 1e-4f));
        ShadeInput behind = in;
        behind.n = -in.n;
        behind.front = false;
        CHECK(near(bumped_normal(behind.n, behind, 1.0f, height), -expected, 1e-4f));
    }
    ShadeInput uncharted = on_plane();
    uncharted.dpdu = uncharted.dpdv = {};
    CHECK(near(bumped_normal(uncharted.n, uncharted, 1.0f, height), expected, 1e-4f));
}

TEST_CASE("relief: heights by texture coordinates tilt by their slope on the surface") {
    ShadeInput in = on_plane();
    in.dpdu = {4, 0, 0};  // u grows by one over four units
    const auto height = [](const ShadeInput& at) { return 2.0f * at.uv.x; };
    CHECK(near(bumped_normal(in.n, in, object_unit(in), height), normalize(Vec3f{-0.5f, 0, 1}),
               1e-4f));
}

TEST_CASE("relief: an object made larger keeps the look of its bumps") {
    ShadeInput in = on_plane();
    const Affinef to_object({0.1f, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f},
                            {});  // placed ten times as large
    in.to_object = &to_object;
    const auto height = [](const ShadeInput& at) { return 0.4f * at.p_object.x; };
    CHECK(near(bumped_normal(in.n, in, object_unit(in), height), normalize(Vec3f{-0.4f, 0, 1}),
               1e-3f));
}

TEST_CASE("relief: heights that are no numbers leave the normal alone") {
    const ShadeInput in = on_plane();
    for (const float bad : {NAN, INFINITY}) {
        const auto height = [&](const ShadeInput& at) { return at.p_world.x > 0 ? bad : 0.0f; };
        CHECK(near(bumped_normal(in.n, in, object_unit(in), height), in.n));
    }
}

TEST_CASE("relief: the bump node, the bump input and a normal map of the same slope agree") {
    const ShadeInput in = on_plane({0.2f, 0.1f, 0});
    const std::string height =
        "{ type = 'multiply', in1 = 0.5, in2 = { type = 'extract', in = { type = 'position' }, "
        "index = 0 } }";
    const Vec3f expected = normalize(Vec3f{-0.5f, 0, 1});
    const ShaderProgram node =
        program_of("geometry_normal = { type = 'bump', height = " + height + " }");
    const ShaderProgram input = program_of("bump = " + height);
    const ShaderProgram map =
        program_of("geometry_normal = { type = 'normalmap', in = [0.276393, 0.5, 0.947214] }");
    for (const ShaderProgram* program : {&node, &input, &map}) {
        REQUIRE(program->bends_normal());
        CHECK(near(program->normal(in, nullptr), expected, 1e-3f));
    }
    CHECK(node.facts().tangent);
    CHECK(node.facts().geometry);
}

TEST_CASE("relief: layers drive bump, opacity, emission, normal and tangent by one mask") {
    const ShaderProgram program = program_of(
        "specular_roughness_anisotropy = 0.5\n"
        "[[material.a.layer]]\nmask = { type = 'extract', in = { type = 'position' } }\n"
        "geometry_opacity = 0\nemission_luminance = 179\nemission_color = [1, 0.5, 0]\n"
        "bump = { type = 'multiply', in1 = 0.5, in2 = { type = 'extract', in = { type = 'position' "
        "}, index = 1 } }\n"
        "geometry_tangent = { type = 'crossproduct', in1 = { type = 'normal' }, in2 = { type = "
        "'tangent' } }\n");
    const ShadeInput out = on_plane({0, 0, 0}), in = on_plane({1, 0, 0});
    CHECK(program.opacity(out, nullptr) == 1.0f);
    CHECK(program.opacity(in, nullptr) == 0.0f);
    CHECK(program.facts().opacity_geometry);
    CHECK(near(program.emission(out, nullptr, 1), Color(0.0f)));
    CHECK(near(program.emission(in, nullptr, 1), {1, 0.5f, 0}));
    CHECK(max_component(program.mean_emission(nullptr)) > 0.0f);
    CHECK(near(program.normal(out, nullptr), {0, 0, 1}));
    CHECK(near(program.normal(in, nullptr), normalize(Vec3f{0, -0.5f, 1}), 1e-3f));
    CHECK(near(normalize(program.tangent(out, nullptr)), {1, 0, 0}));
    CHECK(near(normalize(program.tangent(in, nullptr)), {0, 1, 0}));
}

TEST_CASE("relief: a map with its green downward is the other one turned over") {
    const ShadeInput in = on_plane();
    const Vec3f up = normal_from_tangent_space(in, unpacked_normal({0.6f, 0.7f, 0.9f}, 1));
    CHECK(up.y > 0.2f);
    ShadeInput mirrored = in;
    mirrored.handed = -1;
    CHECK(near(normal_from_tangent_space(mirrored, unpacked_normal({0.6f, 0.7f, 0.9f}, 1)),
               {up.x, -up.y, up.z}));
}

TEST_CASE("terminator: whole in the open, nothing behind, and smooth between") {
    const Vec3f even = normalize(Vec3f{0.4f, 0, 1});
    CHECK(softened_terminator({0, 0, 1}, normalize(Vec3f{0.9f, 0, 0.1f})) == doctest::Approx(1.0));
    CHECK(softened_terminator(even, normalize(Vec3f{-0.99f, 0, 0.1f})) == 0.0f);
    float before = 0;
    for (int i = 0; i <= 200; ++i) {
        const float angle = -1.5f + 3.0f * static_cast<float>(i) / 200;
        const float g = softened_terminator(even, {std::sin(angle), 0, std::cos(angle)});
        CHECK(g >= before - 1e-6f);
        CHECK(g <= 1.0f);
        CHECK(g - before < 0.1f);
        before = g;
    }
}

TEST_CASE("lift: a smooth triangle's points rise to the sphere that its normals are of") {
    Geometry g;
    Mesh mesh;
    mesh.lay_out(true, false, false);
    // A face of 0.2 on the unit sphere.
    for (const Vec3f v : {Vec3f{-0.1f, -0.1f, 1}, Vec3f{0.1f, -0.1f, 1}, Vec3f{0, 0.1f, 1}}) {
        const Vec3f n = normalize(v);
        float* record = mesh.add_vertex(n);
        record[mesh.normal_at] = n.x, record[mesh.normal_at + 1] = n.y;
        record[mesh.normal_at + 2] = n.z;
    }
    mesh.finish_vertices();
    mesh.index = {0, 1, 2};
    mesh.triangles = 1;
    mesh.parts = {{0, 1, false, false}};
    mesh.materials = {0};
    g.meshes.push_back(mesh);
    g.placements.emplace_back();
    Hit hit;
    hit.prim = 0, hit.geom = 0, hit.u = 0.3f, hit.v = 0.3f;
    const SurfacePoint s = surface_point(g, {0, 0}, hit, Ray{}, false);
    const float sunken = 1.0f - length(s.p);
    REQUIRE(sunken > 1e-3f);
    // Second order in the face's size: within a tenth of the depth.
    CHECK(length(s.p + s.lift) == doctest::Approx(1.0).epsilon(0.1 * static_cast<double>(sunken)));
    hit.u = hit.v = 0.0f;
    CHECK(length(surface_point(g, {0, 0}, hit, Ray{}, false).lift) < 1e-5f);
    for (int corner = 0; corner < 3; ++corner) {
        float* n = &g.meshes[0].vertices[std::size_t(corner) * mesh.stride + mesh.normal_at];
        n[0] = n[1] = 0, n[2] = 1;  // an even face
    }
    hit.u = hit.v = 0.3f;
    // The corners lie at heights of their own, within 1 % of the face: no more than that.
    CHECK(length(surface_point(g, {0, 0}, hit, Ray{}, false).lift) < 0.2f * sunken);
}

}  // namespace tessera::test
