// Normals made from faces.

#include "renderer/scene/mesh_normals.h"

#include <doctest/doctest.h>

#include <cmath>

#include "renderer/core/vec.h"
#include "tests/support/cages.h"
#include "tests/support/random.h"

using namespace tessera;

TEST_CASE("mesh normals: exact on a sphere, however unequal the faces") {
    Random random(3);
    for (int round = 0; round < 20; ++round) {
        // A fan about the pole, at angles and distances as they come.
        std::vector<Double3> points{{0, 0, 1}};
        std::vector<std::vector<std::uint32_t>> faces;
        constexpr std::uint32_t kFaces = 7;
        double a = 0;
        for (std::uint32_t i = 0; i < kFaces; ++i) {
            a += 0.3 + static_cast<double>(random.between(0, 0.5f));
            const double down = 0.1 + static_cast<double>(random.between(0, 0.9f));
            points.push_back(
                {std::sin(down) * std::cos(a), std::sin(down) * std::sin(a), std::cos(down)});
            faces.push_back({0, 1 + i, 1 + (i + 1) % kFaces});
        }
        MeshDesc mesh = mesh_of(points, faces);
        mesh.normals.assign(mesh.positions.size(), 0.0f);
        std::vector<std::uint32_t> place(points.size());
        for (std::uint32_t v = 0; v < place.size(); ++v) place[v] = v;
        make_normals(mesh, place, static_cast<std::uint32_t>(place.size()), true);
        CHECK(std::fabs(mesh.normals[0]) < 1e-6f);
        CHECK(std::fabs(mesh.normals[1]) < 1e-6f);
        CHECK(mesh.normals[2] == doctest::Approx(1));
    }
}

TEST_CASE("mesh normals: vertices of one place share theirs if it is smooth or they agreed") {
    // Two triangles at a right angle, their common edge twice there.
    MeshDesc mesh = mesh_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                            {{0, 1, 2}, {4, 3, 5}});
    mesh.normals = {0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0};
    const std::vector<std::uint32_t> place{0, 1, 2, 0, 1, 3};
    MeshDesc hard = mesh, smooth = mesh;
    make_normals(hard, place, 4, false);
    CHECK(hard.normals == mesh.normals);
    make_normals(smooth, place, 4, true);
    for (const std::size_t v : {0u, 3u}) {
        CHECK(smooth.normals[3 * v] == doctest::Approx(std::sqrt(0.5)));
        CHECK(smooth.normals[3 * v + 1] == doctest::Approx(std::sqrt(0.5)));
    }
}
