// A described mesh's separate indices become one; every corner keeps what it had.

#include "renderer/scene/bake.h"

#include <doctest/doctest.h>

using namespace tessera;

namespace {

// Two triangles and a quad over six positions; normals and texture coordinates of their own.
MeshDesc desk() {
    MeshDesc d;
    d.positions = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0};
    d.position_index = {0, 1, 2, 0, 2, 3, 1, 4, 5, 2};
    d.triangles = 2;
    d.quads = 1;
    d.normals = {0, 0, 1, 0, 0.6f, 0.8f};
    d.normal_index = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1};
    d.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
    d.uv_index = {0, 1, 2, 0, 2, 3, 0, 1, 2, 3};
    d.colors.resize(18);
    for (std::size_t i = 0; i < 18; ++i) d.colors[i] = static_cast<float>(i) / 18;
    d.materials = {0};
    return d;
}

std::size_t at(std::uint32_t index, std::size_t width) { return std::size_t(index) * width; }

}  // namespace

TEST_CASE("bake: each corner finds its own position, normal, texture coordinates and colour") {
    const MeshDesc d = desk();
    BakeReport report;
    const Mesh m = bake_mesh(d, Affined(), {}, report);
    REQUIRE(m.index.size() == d.position_index.size());
    for (std::size_t k = 0; k < m.index.size(); ++k) {
        const std::uint32_t v = m.index[k];
        const std::size_t p = at(d.position_index[k], 3), n = at(d.normal_index[k], 3),
                          t = at(d.uv_index[k], 2);
        CHECK(m.position(v) ==
              Vec3f(Vec3d{d.positions[p], d.positions[p + 1], d.positions[p + 2]}));
        CHECK(length(m.normal(v) - Vec3f{d.normals[n], d.normals[n + 1], d.normals[n + 2]}) <
              1e-6f);
        CHECK(m.uv(v) == Vec2f{d.uvs[t], d.uvs[t + 1]});
        CHECK(m.color(v) == Color{d.colors[p], d.colors[p + 1], d.colors[p + 2]});
    }
    // Positions 1 and 2 are met with two normals each; 0 and 3 with one.
    CHECK(m.vertex_count() == 8);
}

TEST_CASE(
    "bake: what nothing reads is not stored, and without separate indices nothing is joined") {
    MeshDesc d = desk();
    d.normals.clear();
    d.normal_index.clear();
    BakeReport report;
    BakeNeeds needs;
    needs.uvs = needs.colors = false;
    const Mesh m = bake_mesh(d, Affined(), needs, report);
    CHECK(m.stride == 3);
    CHECK(m.normal_at == 0);
    CHECK(m.uv_at == 0);
    CHECK(m.color_at == 0);
    CHECK(m.index == d.position_index);
    CHECK(m.vertex_count() == 6);
    CHECK(m.vertices.size() == 6 * 3 + 1);
    CHECK(report.dropped_uvs == (8 + 10) * 4);
    CHECK(report.dropped_colors == 18 * 4);
}

TEST_CASE("bake: a mirror turns faces the other way round, the first corner kept") {
    const MeshDesc d = desk();
    BakeReport report;
    const Mesh m = bake_mesh(d, Affined({-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}), {}, report);
    const std::size_t expected[] = {0, 2, 1, 3, 5, 4, 6, 9, 8, 7};
    for (std::size_t k = 0; k < 10; ++k) {
        const std::size_t p = at(d.position_index[expected[k]], 3),
                          t = at(d.uv_index[expected[k]], 2);
        const Vec3f q = m.position(m.index[k]);
        CHECK(q.x == static_cast<float>(-d.positions[p]));
        CHECK(q.y == static_cast<float>(d.positions[p + 1]));
        CHECK(m.uv(m.index[k]) == Vec2f{d.uvs[t], d.uvs[t + 1]});
    }
}

TEST_CASE("bake: a record of half a cache line never lies on two") {
    MeshDesc d = desk();
    BakeNeeds needs;
    needs.colors = false;
    BakeReport report;
    const Mesh m = bake_mesh(d, Affined(), needs, report);
    REQUIRE(m.stride == 8);
    CHECK(reinterpret_cast<std::uintptr_t>(m.vertices.data()) % 64 == 0);
}
