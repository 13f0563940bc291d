#include "renderer/scene/bake.h"

#include <algorithm>

namespace tessera {
namespace {

constexpr bool kQuad = true;

struct Face {
    std::uint32_t index;  // in the description
    bool quad, cutout;
};

bool degenerate(const std::vector<Vec3f>& p, const std::uint32_t* v, bool quad) {
    const auto area = [&](int a, int b, int c) {
        return length2(cross(p[v[b]] - p[v[a]], p[v[c]] - p[v[a]]));
    };
    if (!quad) return !(area(0, 1, 2) > 0.0f);
    return !(area(0, 1, 3) > 0.0f) && !(area(2, 3, 1) > 0.0f);
}

// Copies a face's corners; mirrored: the other way round, the first corner kept.
void copy_corners(const std::uint32_t* from, bool quad, bool mirrored,
                  std::vector<std::uint32_t>& to) {
    const std::uint32_t n = quad ? 4 : 3;
    to.push_back(from[0]);
    for (std::uint32_t i = 1; i < n; ++i) to.push_back(from[mirrored ? n - i : i]);
}

}  // namespace

Mesh bake_mesh(const MeshDesc& desc, const Affined& place, const BakeNeeds& needs,
               BakeReport& report) {
    Mesh mesh;
    const std::size_t vertices = desc.positions.size() / 3;
    mesh.positions.reserve(vertices + 1);
    for (std::size_t i = 0; i < vertices; ++i) {
        mesh.positions.push_back(Vec3f(place.point(
            {desc.positions[3 * i], desc.positions[3 * i + 1], desc.positions[3 * i + 2]})));
    }
    const bool mirrored = place.determinant() < 0;
    for (std::size_t i = 0; i + 2 < desc.normals.size(); i += 3) {
        const Vec3d n =
            place.normal(Vec3d(Vec3f{desc.normals[i], desc.normals[i + 1], desc.normals[i + 2]}));
        const double l = length(n);
        mesh.normals.push_back(l > 0 ? Vec3f(n / l) : Vec3f{0, 0, 0});
    }
    if (needs.uvs) {
        for (std::size_t i = 0; i + 1 < desc.uvs.size(); i += 2)
            mesh.uvs.push_back({desc.uvs[i], desc.uvs[i + 1]});
    } else {
        report.dropped_uvs +=
            (desc.uvs.size() * sizeof(float)) + desc.uv_index.size() * sizeof(std::uint32_t);
    }
    if (needs.colors) {
        for (std::size_t i = 0; i + 2 < desc.colors.size(); i += 3)
            mesh.colors.push_back({desc.colors[i], desc.colors[i + 1], desc.colors[i + 2]});
    } else {
        report.dropped_colors += desc.colors.size() * sizeof(float);
    }
    mesh.materials.assign(desc.materials.begin(), desc.materials.end());
    if (mesh.materials.empty()) mesh.materials.push_back(-1);

    // Faces in the order of their parts: triangles then quads, within each the opaque ones first.
    const auto corner = [&](std::uint32_t face) {
        return face < desc.triangles
                   ? std::size_t(face) * 3
                   : std::size_t(desc.triangles) * 3 + std::size_t(face - desc.triangles) * 4;
    };
    std::vector<Face> faces;
    faces.reserve(desc.triangles + desc.quads);
    for (std::uint32_t f = 0; f < desc.triangles + desc.quads; ++f) {
        const bool quad = f >= desc.triangles;
        if (degenerate(mesh.positions, &desc.position_index[corner(f)], quad)) {
            ++report.degenerate;
            continue;
        }
        const std::uint32_t slot = desc.face_material.empty() ? 0 : desc.face_material[f];
        faces.push_back(
            {f, quad,
             needs.any_cutout_override || (needs.cutout && needs.cutout(mesh.materials[slot]))});
    }
    std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
        return a.quad != b.quad ? a.quad < b.quad : a.cutout < b.cutout;
    });

    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const Face& f = faces[i];
        if (mesh.parts.empty() || mesh.parts.back().quads != f.quad ||
            mesh.parts.back().cutout != f.cutout) {
            mesh.parts.push_back({i, 0, f.quad, f.cutout});
        }
        ++mesh.parts.back().faces;
        ++(f.quad == kQuad ? mesh.quads : mesh.triangles);
        copy_corners(&desc.position_index[corner(f.index)], f.quad, mirrored, mesh.position_index);
        if (!desc.normal_index.empty())
            copy_corners(&desc.normal_index[corner(f.index)], f.quad, mirrored, mesh.normal_index);
        if (!desc.uv_index.empty() && !mesh.uvs.empty())
            copy_corners(&desc.uv_index[corner(f.index)], f.quad, mirrored, mesh.uv_index);
        if (!desc.face_material.empty())
            mesh.face_material.push_back(static_cast<std::uint16_t>(desc.face_material[f.index]));
        if (!desc.face_object.empty()) mesh.face_object.push_back(desc.face_object[f.index]);
    }
    mesh.positions.push_back({});
    return mesh;
}

}  // namespace tessera
