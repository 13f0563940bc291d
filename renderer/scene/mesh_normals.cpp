#include "renderer/scene/mesh_normals.h"

#include <cmath>
#include <vector>

#include "renderer/core/vec.h"

namespace tessera {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr double kAgree = 0.999;  // cosine

Vec3d triple(const std::vector<float>& of, std::size_t v) {
    return {static_cast<double>(of[3 * v]), static_cast<double>(of[3 * v + 1]),
            static_cast<double>(of[3 * v + 2])};
}

// Each face at a vertex counts by sin(angle) over the product of the two sides: exact where the
// vertices lie on a sphere, however unequal the faces. Max, "Weights for Computing Vertex Normals
// from Facet Normals", JGT 4(2), 1999.
std::vector<Vec3d> face_sums(const MeshDesc& mesh) {
    std::vector<Vec3d> sum(mesh.positions.size() / 3);
    const auto position = [&](std::uint32_t v) {
        const double* p = &mesh.positions[3 * std::size_t(v)];
        return Vec3d{p[0], p[1], p[2]};
    };
    const auto add = [&](const std::uint32_t* v, std::uint32_t corners) {
        for (std::uint32_t k = 0; k < corners; ++k) {
            const Vec3d p = position(v[k]);
            const Vec3d a = position(v[(k + 1) % corners]) - p,
                        b = position(v[(k + corners - 1) % corners]) - p;
            const double weight = length2(a) * length2(b);
            if (weight > 0) sum[v[k]] += cross(a, b) / weight;
        }
    };
    for (std::size_t f = 0; f < mesh.triangles; ++f) add(&mesh.position_index[3 * f], 3);
    const std::size_t quads = 3 * std::size_t(mesh.triangles);
    for (std::size_t f = 0; f < mesh.quads; ++f) add(&mesh.position_index[quads + 4 * f], 4);
    return sum;
}

}  // namespace

void make_normals(MeshDesc& mesh, std::span<const std::uint32_t> place, std::uint32_t places,
                  bool smooth) {
    const std::vector<Vec3d> sum = face_sums(mesh);
    const std::vector<float> before = mesh.normals;
    std::vector<std::uint32_t> first(places, kNone), next(place.size(), kNone);
    for (auto v = static_cast<std::uint32_t>(place.size()); v-- > 0;) {
        next[v] = first[place[v]];
        first[place[v]] = v;
    }
    for (std::size_t v = 0; v < place.size(); ++v) {
        Vec3d n = sum[v];
        const bool alone = first[place[v]] == v && next[v] == kNone;
        if (!alone) {
            n = {};
            for (std::uint32_t w = first[place[v]]; w != kNone; w = next[w])
                if (smooth || dot(triple(before, v), triple(before, w)) > kAgree) n += sum[w];
        }
        const double l = length(n);
        if (!(l > 0)) continue;
        const Vec3f unit(n / l);
        mesh.normals[3 * v] = unit.x, mesh.normals[3 * v + 1] = unit.y;
        mesh.normals[3 * v + 2] = unit.z;
    }
}

}  // namespace tessera
