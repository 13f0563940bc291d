#pragma once
// Small meshes to be subdivided.

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// Faces of three or four corners over shared points.
inline MeshDesc mesh_of(const std::vector<Double3>& points,
                        const std::vector<std::vector<std::uint32_t>>& faces) {
    MeshDesc mesh;
    for (const Double3& p : points) mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
    for (const std::size_t corners : {3u, 4u}) {
        for (const auto& face : faces) {
            if (face.size() != corners) continue;
            mesh.position_index.insert(mesh.position_index.end(), face.begin(), face.end());
            ++(corners == 3 ? mesh.triangles : mesh.quads);
        }
    }
    mesh.materials = {-1};
    return mesh;
}

/// The cube [-1, 1]^3, outward.
inline MeshDesc cube_cage() {
    return mesh_of(
        {{-1, -1, -1},
         {1, -1, -1},
         {1, 1, -1},
         {-1, 1, -1},
         {-1, -1, 1},
         {1, -1, 1},
         {1, 1, 1},
         {-1, 1, 1}},
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

/// Triangles and a quad, closed.
inline MeshDesc pyramid_cage() {
    return mesh_of({{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0.2, 1.5, 0}},
                   {{0, 1, 2, 3}, {1, 0, 4}, {2, 1, 4}, {3, 2, 4}, {0, 3, 4}});
}

/// Quads and one triangle around a point, open all around.
inline MeshDesc star_cage(int quads) {
    std::vector<Double3> points{{0, 0.3, 0}};
    std::vector<std::vector<std::uint32_t>> faces;
    const int n = quads + 1;
    for (int i = 0; i < 2 * n; ++i) {
        const double a = 3.14159265358979 * i / n, r = i % 2 ? 1.6 : 1.0;
        points.push_back({r * std::cos(a), 0.1 * (i % 3), -r * std::sin(a)});
    }
    const auto rim = [&](int i) { return static_cast<std::uint32_t>(1 + i % (2 * n)); };
    for (int i = 0; i < quads; ++i)
        faces.push_back({0, rim(2 * i), rim(2 * i + 1), rim(2 * i + 2)});
    faces.push_back({0, rim(2 * quads), rim(2 * quads + 2)});
    return mesh_of(points, faces);
}

/// n x n quads over [0, 1]^2 of x and -z, facing up, uvs as the unit square.
inline MeshDesc grid_cage(int n) {
    std::vector<Double3> points;
    std::vector<std::vector<std::uint32_t>> faces;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
            points.push_back({static_cast<double>(i) / n, 0, -static_cast<double>(j) / n});
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    MeshDesc mesh = mesh_of(points, faces);
    for (const Double3& p : points) {
        mesh.uvs.push_back(static_cast<float>(p[0]));
        mesh.uvs.push_back(static_cast<float>(-p[2]));
    }
    return mesh;
}

/// A cube of n x n quads a side blown up to the unit sphere; each side a texture chart of its own.
inline MeshDesc sphere_cage(int n) {
    std::vector<Double3> points;
    std::vector<std::vector<std::uint32_t>> faces;
    std::map<std::vector<int>, std::uint32_t> known;
    const auto point = [&](std::vector<int> at) {
        const auto [entry, is_new] =
            known.try_emplace(at, static_cast<std::uint32_t>(points.size()));
        if (is_new) {
            double p[3], l = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                // Even angles across a side.
                p[k] = std::tan(0.25 * 3.14159265358979 * (2.0 * at[k] / n - 1));
                l += p[k] * p[k];
            }
            l = std::sqrt(l);
            points.push_back({p[0] / l, p[1] / l, p[2] / l});
        }
        return entry->second;
    };
    MeshDesc uvs;
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, n}) {
            const auto at = [&](int u, int v) {
                if (side == 0) std::swap(u, v);
                std::vector<int> c(3);
                c[static_cast<std::size_t>(axis)] = side;
                c[static_cast<std::size_t>((axis + 1) % 3)] = u;
                c[static_cast<std::size_t>((axis + 2) % 3)] = v;
                return point(c);
            };
            for (int v = 0; v < n; ++v) {
                for (int u = 0; u < n; ++u) {
                    faces.push_back({at(u, v), at(u + 1, v), at(u + 1, v + 1), at(u, v + 1)});
                    for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
                        uvs.uv_index.push_back(
                            static_cast<std::uint32_t>((2 * axis + (side > 0)) * (n + 1) *
                                                       (n + 1)) +
                            static_cast<std::uint32_t>((v + dv) * (n + 1) + u + du));
                    }
                }
            }
            for (int v = 0; v <= n; ++v)
                for (int u = 0; u <= n; ++u)
                    uvs.uvs.insert(uvs.uvs.end(), {static_cast<float>(u) / static_cast<float>(n),
                                                   static_cast<float>(v) / static_cast<float>(n)});
        }
    }
    MeshDesc mesh = mesh_of(points, faces);
    mesh.uvs = uvs.uvs;
    mesh.uv_index = uvs.uv_index;
    return mesh;
}

}  // namespace tessera
