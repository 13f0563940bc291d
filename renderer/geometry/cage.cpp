#include "renderer/geometry/cage.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace tessera {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

Vec3d position(const MeshDesc& mesh, std::uint32_t i) {
    const double* p = &mesh.positions[3 * std::size_t(i)];
    return {p[0], p[1], p[2]};
}

// For each position of the description its place; fills in the cage's places.
std::vector<std::uint32_t> weld(const MeshDesc& mesh, Cage& cage) {
    const auto count = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    Vec3d lo(1e300), hi(-1e300);
    for (const std::uint32_t i : mesh.position_index) {
        lo = min(lo, position(mesh, i));
        hi = max(hi, position(mesh, i));
    }
    cage.origin = mesh.position_index.empty() ? Vec3d{} : (lo + hi) * 0.5;
    std::vector<std::uint32_t> order(count), of(count);
    std::iota(order.begin(), order.end(), 0u);
    // To a hundred-millionth of the mesh: the seam of a ball meets itself but for rounding.
    const double grid = std::max(max_component(hi - lo) * 1e-8, 1e-300);
    const auto key = [&](std::uint32_t i) {
        const Vec3d p = (position(mesh, i) - cage.origin) * (1.0 / grid);
        return std::array<double, 3>{std::round(p.x), std::round(p.y), std::round(p.z)};
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const auto ka = key(a), kb = key(b);
        return ka != kb ? ka < kb : a < b;
    });
    for (std::uint32_t i = 0; i < count; ++i) {
        const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
        of[order[i]] = same ? of[order[i - 1]] : order[i];
    }
    // Numbered in the file's order, which keeps neighbours near.
    for (std::uint32_t i = 0; i < count; ++i) {
        if (of[i] == i) {
            of[i] = static_cast<std::uint32_t>(cage.places.size());
            cage.places.push_back(Vec3f(position(mesh, i) - cage.origin));
        } else {
            of[i] = of[of[i]];
        }
    }
    cage.places.emplace_back();
    return of;
}

void take_faces(const MeshDesc& mesh, const std::vector<std::uint32_t>& of, Cage& cage) {
    std::uint32_t corner = 0;
    for (std::uint32_t f = 0; f < mesh.triangles + mesh.quads; ++f) {
        const std::uint32_t count = f < mesh.triangles ? 3 : 4;
        const auto first = static_cast<std::uint32_t>(cage.place.size());
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t place = of[mesh.position_index[corner + k]];
            const auto begin = cage.place.begin() + first;
            if (std::find(begin, cage.place.end(), place) != cage.place.end()) continue;
            cage.place.push_back(place);
            cage.source.push_back(corner + k);
        }
        corner += count;
        const auto kept = static_cast<std::uint32_t>(cage.place.size()) - first;
        if (kept >= 3) {
            cage.faces.push_back({first, kept, f});
        } else {
            cage.place.resize(first);
            cage.source.resize(first);
            ++cage.dropped;
        }
    }
}

void find_edges(Cage& cage) {
    struct Half {
        std::uint32_t a, b, corner;
        bool triangle;
    };
    std::vector<Half> halves;
    halves.reserve(cage.place.size());
    for (const Cage::Face& f : cage.faces) {
        for (std::uint32_t k = 0; k < f.corners; ++k) {
            const std::uint32_t p = cage.place[f.first + k],
                                q = cage.place[f.first + cage.next(f, k)];
            halves.push_back({std::min(p, q), std::max(p, q), f.first + k, f.corners == 3});
        }
    }
    std::sort(halves.begin(), halves.end(), [](const Half& x, const Half& y) {
        return x.a != y.a ? x.a < y.a : (x.b != y.b ? x.b < y.b : x.corner < y.corner);
    });
    cage.edge.resize(cage.place.size());
    for (const Half& h : halves) {
        if (cage.edges.empty() || cage.edges.back().a != h.a || cage.edges.back().b != h.b)
            cage.edges.push_back({h.a, h.b});
        cage.edges.back().triangle |= h.triangle;
        cage.edge[h.corner] = static_cast<std::uint32_t>(cage.edges.size()) - 1;
    }
}

void find_wedges(const MeshDesc& mesh, bool split_by_normal, Cage& cage) {
    struct Wedge {
        std::uint32_t uv, normal, material, next;
    };
    std::vector<Wedge> wedges;
    std::vector<std::uint32_t> first(cage.places.size(), kNone);
    cage.wedge.resize(cage.place.size());
    for (const Cage::Face& f : cage.faces) {
        const std::uint32_t material =
            mesh.face_material.empty() ? 0 : mesh.face_material[f.source];
        for (std::uint32_t c = f.first; c < f.first + f.corners; ++c) {
            const std::uint32_t corner = cage.source[c];
            const std::uint32_t uv = mesh.uvs.empty() ? 0 : uv_entry(mesh, corner);
            const std::uint32_t normal =
                split_by_normal && !mesh.normals.empty() ? normal_entry(mesh, corner) : 0;
            std::uint32_t w = first[cage.place[c]];
            while (w != kNone && (wedges[w].uv != uv || wedges[w].normal != normal ||
                                  wedges[w].material != material))
                w = wedges[w].next;
            if (w == kNone) {
                w = static_cast<std::uint32_t>(wedges.size());
                wedges.push_back({uv, normal, material, first[cage.place[c]]});
                first[cage.place[c]] = w;
            }
            cage.wedge[c] = w;
        }
    }
    cage.wedges = static_cast<std::uint32_t>(wedges.size());
}

}  // namespace

Cage make_cage(const MeshDesc& mesh, bool split_by_normal) {
    Cage cage;
    const std::vector<std::uint32_t> of = weld(mesh, cage);
    take_faces(mesh, of, cage);
    find_edges(cage);
    find_wedges(mesh, split_by_normal, cage);
    return cage;
}

std::uint32_t Cage::valence() const {
    std::vector<std::uint32_t> count(places.size(), 0);
    std::uint32_t most = 0;
    for (const std::uint32_t p : place) most = std::max(most, ++count[p]);
    return most;
}

std::size_t Cage::bytes() const noexcept {
    return places.capacity() * sizeof(Vec3f) + faces.capacity() * sizeof(Face) +
           edges.capacity() * sizeof(Edge) +
           (place.capacity() + edge.capacity() + source.capacity() + wedge.capacity()) *
               sizeof(std::uint32_t);
}

}  // namespace tessera
