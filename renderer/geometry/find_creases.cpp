#include "renderer/geometry/find_creases.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace tessera {
namespace {

// Faces at one edge that are compared with each other; more are hardly meant.
constexpr std::size_t kMostFaces = 8;
// A face folded back on another is convex from both sides, whatever rounding says.
constexpr double kFolded = 3.1415;

// A face's side of an edge from corner a to corner b > a.
struct Side {
    std::uint32_t a, b, face;
    bool forward;  // the face runs from a to b
};

Vec3d position(const MeshDesc& mesh, std::uint32_t v) {
    const double* p = &mesh.positions[3 * std::size_t(v)];
    return {p[0], p[1], p[2]};
}

// For each position the first one at its place.
std::vector<std::uint32_t> welded(const MeshDesc& mesh) {
    std::vector<std::uint32_t> order(mesh.positions.size() / 3), first(order.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) {
        const Vec3d p = position(mesh, v);
        return std::tuple(p.x, p.y, p.z);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t v, std::uint32_t w) {
        return std::tuple_cat(key(v), std::tuple(v)) < std::tuple_cat(key(w), std::tuple(w));
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
        first[order[i]] = same ? first[order[i - 1]] : order[i];
    }
    return first;
}

class Finder {
public:
    Finder(const MeshDesc& mesh, float least) : mesh_(mesh), least_(static_cast<double>(least)) {
        const std::vector<std::uint32_t> first = welded(mesh);
        sides_.reserve(mesh.position_index.size());
        for (std::uint32_t f = 0; f < mesh.triangles + mesh.quads; ++f) {
            if (!(length2(normal(f)) > 0)) continue;
            const std::uint32_t n = corners(f);
            for (std::uint32_t c = 0; c < n; ++c) {
                const std::uint32_t a = first[corner(f, c)], b = first[corner(f, (c + 1) % n)];
                if (a != b) sides_.push_back({std::min(a, b), std::max(a, b), f, a < b});
            }
        }
        std::sort(sides_.begin(), sides_.end(), [](const Side& s, const Side& t) {
            return std::tie(s.a, s.b, s.face) < std::tie(t.a, t.b, t.face);
        });
    }

    std::vector<Crease> creases() const {
        std::vector<Crease> found;
        for (std::size_t i = 0, end = 0; i < sides_.size(); i = end) {
            for (end = i + 1; end < sides_.size() && sides_[end].a == sides_[i].a &&
                              sides_[end].b == sides_[i].b;)
                ++end;
            add(i, std::min(end, i + kMostFaces), found);
        }
        return found;
    }

private:
    std::uint32_t corners(std::uint32_t face) const { return face < mesh_.triangles ? 3 : 4; }
    std::uint32_t corner(std::uint32_t face, std::uint32_t c) const {
        const std::size_t quads = 3 * std::size_t(mesh_.triangles);
        return mesh_.position_index[face < mesh_.triangles
                                        ? 3 * std::size_t(face) + c
                                        : quads + 4 * std::size_t(face - mesh_.triangles) + c];
    }
    // Twice the face's area long.
    Vec3d normal(std::uint32_t face) const {
        const auto at = [&](std::uint32_t c) { return position(mesh_, corner(face, c)); };
        return corners(face) == 3 ? cross(at(1) - at(0), at(2) - at(0))
                                  : cross(at(2) - at(0), at(3) - at(1));
    }

    // The angle by which the second face is bent away from the first one's front.
    double bend(const Side& one, const Side& other) const {
        const Vec3d n = normalize(normal(one.face));
        Vec3d m = normalize(normal(other.face));
        if (one.forward == other.forward) m = -m;  // wound the other way round
        const Vec3d along = normalize(position(mesh_, one.b) - position(mesh_, one.a));
        const double sine = dot(cross(n, m), along) * (one.forward ? 1 : -1);
        const double angle = std::atan2(sine, dot(n, m));
        return std::fabs(angle) > kFolded ? std::fabs(angle) : angle;
    }

    void add(std::size_t first, std::size_t last, std::vector<Crease>& found) const {
        double convex = 0, concave = 0;
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = i + 1; j < last; ++j) {
                const double angle = bend(sides_[i], sides_[j]);
                convex = std::max(convex, angle), concave = std::min(concave, angle);
                if (angle > kFolded) concave = -angle;
            }
        const Vec3f a(position(mesh_, sides_[first].a)), b(position(mesh_, sides_[first].b));
        if (convex >= least_ && convex > 0) found.push_back({a, b, static_cast<float>(convex)});
        if (-concave >= least_ && concave < 0) found.push_back({a, b, static_cast<float>(concave)});
    }

    const MeshDesc& mesh_;
    double least_;
    std::vector<Side> sides_;
};

}  // namespace

std::vector<Crease> find_creases(const MeshDesc& mesh, float least) {
    return Finder(mesh, least).creases();
}

}  // namespace tessera
