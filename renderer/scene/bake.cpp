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

Vec3f baked_normal(const MeshDesc& desc, std::size_t i, const Affined& place) {
    const Vec3d n = place.normal(
        Vec3d(Vec3f{desc.normals[3 * i], desc.normals[3 * i + 1], desc.normals[3 * i + 2]}));
    const double l = length(n);
    return l > 0 ? Vec3f(n / l) : Vec3f{0, 0, 0};
}

// The description's separate indices made one: a vertex for each position, normal and texture
// coordinate that some corner joins. Without separate indices they are the positions, as they are.
class VertexJoiner {
public:
    VertexJoiner(const MeshDesc& desc, const Affined& place, const std::vector<Vec3f>& positions,
                 Mesh& mesh)
        : desc_(desc),
          place_(place),
          positions_(positions),
          mesh_(mesh),
          separate_((mesh.normal_at > 0 && !desc.normal_index.empty()) ||
                    (mesh.uv_at > 0 && !desc.uv_index.empty())) {
        mesh.vertices.reserve(positions.size() * mesh.stride + 1);
        if (separate_) {
            first_.assign(positions.size(), kNone);
        } else {
            for (std::uint32_t v = 0; v < positions.size(); ++v) add(v, v, v);
        }
    }

    // The vertex of an entry of the description's index.
    std::uint32_t vertex(std::size_t corner) {
        const std::uint32_t p = desc_.position_index[corner];
        if (!separate_) return p;
        const std::uint32_t n = mesh_.normal_at == 0
                                    ? 0
                                    : (desc_.normal_index.empty() ? p : desc_.normal_index[corner]);
        const std::uint32_t t =
            mesh_.uv_at == 0 ? 0 : (desc_.uv_index.empty() ? p : desc_.uv_index[corner]);
        for (std::uint32_t v = first_[p]; v != kNone; v = joined_[v].next)
            if (joined_[v].normal == n && joined_[v].uv == t) return v;
        const auto v = static_cast<std::uint32_t>(joined_.size());
        joined_.push_back({n, t, first_[p]});
        first_[p] = v;
        add(p, n, t);
        return v;
    }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    struct Joined {
        std::uint32_t normal, uv, next;
    };

    void add(std::uint32_t p, std::uint32_t n, std::uint32_t t) {
        float* record = mesh_.add_vertex(positions_[p]);
        if (mesh_.normal_at > 0) {
            const Vec3f normal = baked_normal(desc_, n, place_);
            record[mesh_.normal_at] = normal.x;
            record[mesh_.normal_at + 1] = normal.y;
            record[mesh_.normal_at + 2] = normal.z;
        }
        if (mesh_.uv_at > 0) std::copy_n(&desc_.uvs[2 * std::size_t(t)], 2, record + mesh_.uv_at);
        if (mesh_.color_at > 0)
            std::copy_n(&desc_.colors[3 * std::size_t(p)], 3, record + mesh_.color_at);
    }

    const MeshDesc& desc_;
    const Affined& place_;
    const std::vector<Vec3f>& positions_;
    Mesh& mesh_;
    bool separate_;
    std::vector<std::uint32_t> first_;  // per position: its newest vertex
    std::vector<Joined> joined_;
};

}  // namespace

Mesh bake_mesh(const MeshDesc& desc, const Affined& place, const BakeNeeds& needs,
               BakeReport& report) {
    Mesh mesh;
    std::vector<Vec3f> positions;
    positions.reserve(desc.positions.size() / 3);
    for (std::size_t i = 0; i + 2 < desc.positions.size(); i += 3) {
        positions.push_back(
            Vec3f(place.point({desc.positions[i], desc.positions[i + 1], desc.positions[i + 2]})));
    }
    const bool mirrored = place.determinant() < 0;
    mesh.lay_out(!desc.normals.empty(), needs.uvs && !desc.uvs.empty(),
                 needs.colors && !desc.colors.empty());
    if (!needs.uvs)
        report.dropped_uvs +=
            (desc.uvs.size() * sizeof(float)) + desc.uv_index.size() * sizeof(std::uint32_t);
    if (!needs.colors) report.dropped_colors += desc.colors.size() * sizeof(float);
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
        if (degenerate(positions, &desc.position_index[corner(f)], quad)) {
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

    VertexJoiner joiner(desc, place, positions, mesh);
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        const Face& f = faces[i];
        if (mesh.parts.empty() || mesh.parts.back().quads != f.quad ||
            mesh.parts.back().cutout != f.cutout) {
            mesh.parts.push_back({i, 0, f.quad, f.cutout});
        }
        ++mesh.parts.back().faces;
        ++(f.quad == kQuad ? mesh.quads : mesh.triangles);
        // Mirrored: the other way round, the first corner kept.
        const std::uint32_t corners = f.quad ? 4 : 3;
        for (std::uint32_t c = 0; c < corners; ++c) {
            const std::uint32_t from = mirrored && c > 0 ? corners - c : c;
            mesh.index.push_back(joiner.vertex(corner(f.index) + from));
        }
        if (!desc.face_material.empty())
            mesh.face_material.push_back(static_cast<std::uint16_t>(desc.face_material[f.index]));
        if (needs.objects && !desc.face_object.empty())
            mesh.face_object.push_back(desc.face_object[f.index]);
    }
    mesh.finish_vertices();
    mesh.vertices.shrink_to_fit();
    return mesh;
}

}  // namespace tessera
