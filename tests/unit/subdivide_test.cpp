// The limit surface that Embree evaluates against Catmull and Clark's rules carried out by hand.

#include "renderer/geometry/subdivide.h"

#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "tests/support/cages.h"
#include "tests/support/random.h"

using namespace tessera;

namespace {

// A closed mesh of quads, each a square of the parameters of a face of the first cage.
struct Refined {
    struct Quad {
        std::uint32_t v[4];
        std::uint32_t face, patch;
        float s0, t0, size;
    };
    std::vector<Vec3d> points;
    std::vector<Quad> quads;
};

using Edge = std::pair<std::uint32_t, std::uint32_t>;
Edge edge_of(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

struct Polygon {
    std::vector<std::uint32_t> v;
};

// One step of Catmull-Clark on a closed mesh: vertices, then one per edge, then one per face.
struct Step {
    std::vector<Vec3d> points;
    std::map<Edge, std::uint32_t> edge_point;
    std::vector<std::uint32_t> face_point;
};

Step refine(const std::vector<Vec3d>& points, const std::vector<Polygon>& faces) {
    Step out;
    std::vector<Vec3d> face_points;
    std::map<Edge, std::vector<Vec3d>> beside;
    for (const Polygon& f : faces) {
        Vec3d middle;
        for (const std::uint32_t v : f.v) middle += points[v];
        middle = middle / static_cast<double>(f.v.size());
        face_points.push_back(middle);
        for (std::size_t k = 0; k < f.v.size(); ++k)
            beside[edge_of(f.v[k], f.v[(k + 1) % f.v.size()])].push_back(middle);
    }
    std::vector<Vec3d> mean_face(points.size()), mean_edge(points.size());
    std::vector<double> valence(points.size(), 0);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (const std::uint32_t v : faces[f].v) mean_face[v] += face_points[f], valence[v] += 1;
    for (const auto& [e, middles] : beside) {
        const Vec3d middle = (points[e.first] + points[e.second]) * 0.5;
        mean_edge[e.first] += middle;
        mean_edge[e.second] += middle;
    }
    for (std::size_t v = 0; v < points.size(); ++v) {
        const double n = valence[v];
        out.points.push_back((mean_face[v] / n + mean_edge[v] * (2 / n) + points[v] * (n - 3)) / n);
    }
    for (const auto& [e, middles] : beside) {
        out.edge_point[e] = static_cast<std::uint32_t>(out.points.size());
        out.points.push_back((points[e.first] + points[e.second] + middles.at(0) + middles.at(1)) *
                             0.25);
    }
    for (const Vec3d& p : face_points) {
        out.face_point.push_back(static_cast<std::uint32_t>(out.points.size()));
        out.points.push_back(p);
    }
    return out;
}

Refined refined(const Cage& cage, int steps) {
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i + 1 < cage.places.size(); ++i)
        points.push_back(Vec3d(cage.places[i]));
    std::vector<Polygon> faces;
    for (const Cage::Face& f : cage.faces)
        faces.push_back({{cage.place.begin() + f.first, cage.place.begin() + f.first + f.corners}});
    Step step = refine(points, faces);
    Refined out{step.points, {}};
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const auto& v = faces[f].v;
        const auto n = static_cast<std::uint32_t>(v.size());
        for (std::uint32_t k = 0; k < n; ++k) {
            const std::uint32_t next = step.edge_point[edge_of(v[k], v[(k + 1) % n])],
                                before = step.edge_point[edge_of(v[k], v[(k + n - 1) % n])],
                                middle = step.face_point[f];
            if (n == 3) {
                out.quads.push_back({{v[k], next, middle, before}, f, k, 0, 0, 1});
            } else {
                // Turned so that the first corner has the least parameters.
                const float s0 = k == 1 || k == 2 ? 0.5f : 0.0f, t0 = k >= 2 ? 0.5f : 0.0f;
                const std::uint32_t ring[4] = {v[k], next, middle, before};
                Refined::Quad q{{}, f, 0, s0, t0, 0.5f};
                for (std::uint32_t c = 0; c < 4; ++c) q.v[c] = ring[(c + 4 - k) % 4];
                out.quads.push_back(q);
            }
        }
    }
    for (int i = 1; i < steps; ++i) {
        faces.clear();
        for (const auto& q : out.quads) faces.push_back({{q.v, q.v + 4}});
        step = refine(out.points, faces);
        Refined finer{step.points, {}};
        for (std::uint32_t f = 0; f < faces.size(); ++f) {
            const Refined::Quad& q = out.quads[f];
            const float half = 0.5f * q.size;
            for (std::uint32_t k = 0; k < 4; ++k) {
                const std::uint32_t ring[4] = {
                    q.v[k], step.edge_point[edge_of(q.v[k], q.v[(k + 1) % 4])], step.face_point[f],
                    step.edge_point[edge_of(q.v[k], q.v[(k + 3) % 4])]};
                Refined::Quad part{{},
                                   q.face,
                                   q.patch,
                                   q.s0 + (k == 1 || k == 2 ? half : 0),
                                   q.t0 + (k >= 2 ? half : 0),
                                   half};
                for (std::uint32_t c = 0; c < 4; ++c) part.v[c] = ring[(c + 4 - k) % 4];
                finer.quads.push_back(part);
            }
        }
        out = std::move(finer);
    }
    return out;
}

// Where a vertex of a closed mesh of quads ends up: Halstead, Kass and DeRose, "Efficient, Fair
// Interpolation using Catmull-Clark Surfaces", 1993.
std::vector<Vec3d> limits(const Refined& mesh) {
    std::vector<Vec3d> near(mesh.points.size()), across(mesh.points.size());
    std::vector<double> valence(mesh.points.size(), 0);
    for (const auto& q : mesh.quads) {
        for (int k = 0; k < 4; ++k) {
            near[q.v[k]] += mesh.points[q.v[(k + 1) % 4]];
            across[q.v[k]] += mesh.points[q.v[(k + 2) % 4]];
            valence[q.v[k]] += 1;
        }
    }
    std::vector<Vec3d> out;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const double n = valence[v];
        out.push_back((mesh.points[v] * (n * n) + near[v] * 4.0 + across[v]) / (n * (n + 5)));
    }
    return out;
}

MeshDesc smooth(MeshDesc mesh) {
    mesh.subdivision.scheme = Subdivision::catmull_clark;
    return mesh;
}

}  // namespace

TEST_CASE("subdivide: the limit of a cube and of a pyramid is that of Catmull and Clark's rules") {
    for (const MeshDesc& mesh : {smooth(cube_cage()), smooth(pyramid_cage())}) {
        const Cage cage = make_cage(mesh, false);
        const LimitSurface surface(mesh, cage, 1, "");
        const Refined fine = refined(cage, 4);
        const std::vector<Vec3d> expected = limits(fine);
        double worst = 0;
        for (const auto& q : fine.quads) {
            for (std::uint32_t c = 0; c < 4; ++c) {
                const float s = q.s0 + (c == 1 || c == 2 ? q.size : 0),
                            t = q.t0 + (c >= 2 ? q.size : 0);
                const LimitPoint at = surface.at({q.face, q.patch, s, t});
                worst = std::max(worst, length(Vec3d(at.p) - expected[q.v[c]]));
            }
        }
        // Embree ends an extraordinary corner after ten levels, and computes in floats.
        CHECK(worst < 2e-6);
    }
}

TEST_CASE("subdivide: normals stand on the limit surface, at extraordinary corners too") {
    const MeshDesc mesh = smooth(pyramid_cage());
    const Cage cage = make_cage(mesh, false);
    const LimitSurface surface(mesh, cage, 1, "");
    const Refined fine = refined(cage, 7);
    const std::vector<Vec3d> points = limits(fine);
    std::vector<Vec3d> normals(points.size());
    for (const auto& q : fine.quads)
        for (int k = 0; k < 4; ++k)
            normals[q.v[k]] += cross(points[q.v[(k + 1) % 4]] - points[q.v[k]],
                                     points[q.v[(k + 3) % 4]] - points[q.v[k]]);
    double worst = 1;
    for (const auto& q : fine.quads) {
        const LimitPoint at = surface.at({q.face, q.patch, q.s0, q.t0});
        worst = std::min(worst, dot(Vec3d(at.n), normalize(normals[q.v[0]])));
    }
    // The mean of fine faces is itself good to the faces' size, a hundredth.
    CHECK(worst > std::cos(0.01));
}

TEST_CASE("subdivide: a flat sheet stays flat, its outline as the boundary's rule has it") {
    MeshDesc mesh = smooth(grid_cage(1));
    const Cage cage = make_cage(mesh, false);
    const auto corner_x = [&](SubdivisionBoundary boundary) {
        mesh.subdivision.boundary = boundary;
        const LimitSurface surface(mesh, cage, 1, "");
        for (const float s : {0.0f, 0.3f, 1.0f}) {
            for (const float t : {0.0f, 0.7f, 1.0f}) {
                const LimitPoint at = surface.at({0, 0, s, t});
                CHECK(std::fabs(at.p.y) < 1e-7f);
                CHECK(at.n.y == doctest::Approx(1));
                CHECK(std::fabs(at.uv.x - s) < 1e-6f);
                CHECK(std::fabs(at.uv.y - t) < 1e-6f);
            }
        }
        return surface.at({0, 0, 0, 0}).p.x;
    };
    CHECK(corner_x(SubdivisionBoundary::pin_corners) == doctest::Approx(-0.5));
    CHECK(corner_x(SubdivisionBoundary::pin) == doctest::Approx(-0.5));
    // The corner of a closed cubic B-spline: (1, 4, 1) / 6 of itself and its neighbours.
    CHECK(corner_x(SubdivisionBoundary::smooth) == doctest::Approx(-0.5 + 1.0 / 6));
}

TEST_CASE("subdivide: texture coordinates that a hundred faces share are evaluated") {
    // A ring whose lower rim has one texture coordinate.
    constexpr std::uint32_t kFaces = 100;
    std::vector<Double3> points;
    std::vector<std::vector<std::uint32_t>> faces;
    for (std::uint32_t i = 0; i < kFaces; ++i) {
        const double a = 2 * 3.14159265358979 * i / kFaces;
        for (const double y : {0.0, 1.0}) points.push_back({std::cos(a), y, std::sin(a)});
        const std::uint32_t b = (i + 1) % kFaces;
        faces.push_back({2 * i, 2 * i + 1, 2 * b + 1, 2 * b});
    }
    MeshDesc mesh = smooth(mesh_of(points, faces));
    for (std::uint32_t i = 0; i < 2 * kFaces; ++i)
        mesh.uvs.insert(mesh.uvs.end(),
                        {i % 2 ? static_cast<float>(i) / (2 * kFaces) : 0.5f, i % 2 ? 1.0f : 0.0f});
    for (const std::uint32_t i : mesh.position_index) mesh.uv_index.push_back(i % 2 ? i : 0);
    const Cage cage = make_cage(mesh, false);
    const LimitSurface surface(mesh, cage, 1, "");
    for (std::uint32_t f = 0; f < kFaces; ++f) {
        CHECK(surface.at({f, 0, 0, 0}).uv == Vec2f{0.5f, 0.0f});
        CHECK(surface.at({f, 0, 1, 1}).uv.y == doctest::Approx(1));
    }
}

TEST_CASE("subdivide: positions that only rounding keeps apart are one") {
    // Two squares side by side; the second has the shared edge at 1 + 1e-16 and a zero of its own.
    const MeshDesc mesh = mesh_of({{0, 0, 0},
                                   {1, 0, 0},
                                   {1, 1, 0},
                                   {0, 1, 0},
                                   {1 + 2.3e-16, -2.4e-16, 0},
                                   {2, 0, 0},
                                   {2, 1, 0},
                                   {1, 1, 1e-17}},
                                  {{0, 1, 2, 3}, {4, 5, 6, 7}});
    CHECK(make_cage(mesh, false).edges.size() == 7);
}

TEST_CASE("subdivide: a soup of faces without order is evaluated, each in its place") {
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        std::vector<Double3> points(12);
        for (Double3& p : points)
            for (double& x : p) x = static_cast<double>(random.between(-1, 1));
        std::vector<std::vector<std::uint32_t>> faces(10);
        for (auto& f : faces)
            for (int k = 0; k < (random.unit() < 0.5f ? 3 : 4); ++k)
                f.push_back(static_cast<std::uint32_t>(random.between(0, 11.9f)));
        std::erase_if(faces, [](const auto& f) { return f.size() < 3; });
        const MeshDesc mesh = smooth(mesh_of(points, faces));
        const Cage cage = make_cage(mesh, false);
        if (cage.faces.empty()) continue;
        const LimitSurface surface(mesh, cage, 1, "");
        const Diced d = dice(cage, std::vector<int>(cage.edges.size(), 4));
        for (const DiceSite& site : d.sites) CHECK(max_component(abs(surface.at(site).p)) < 2.5f);
    }
}

TEST_CASE("subdivide: a linear cage keeps its points, its normals and its texture coordinates") {
    MeshDesc mesh = pyramid_cage();
    mesh.subdivision.scheme = Subdivision::linear;
    const Cage cage = make_cage(mesh, true);
    const LimitSurface surface(mesh, cage, 1, "");
    for (std::uint32_t f = 0; f < cage.faces.size(); ++f) {
        const Cage::Face& face = cage.faces[f];
        const Vec3f n = normalize(
            cross(cage.at(face, 1) - cage.at(face, 0), cage.at(face, 2) - cage.at(face, 0)));
        for (std::uint32_t patch = 0; patch < (face.corners == 3 ? 3u : 1u); ++patch) {
            for (const float s : {0.0f, 0.4f, 1.0f}) {
                const LimitPoint at = surface.at({f, patch, s, 0.8f});
                CHECK(std::fabs(dot(at.p - cage.at(face, 0), n)) < 1e-6f);
                CHECK(dot(at.n, n) == doctest::Approx(1));
            }
            if (face.corners == 3) {
                CHECK(length(surface.at({f, patch, 0, 0}).p - cage.at(face, patch)) < 1e-6f);
                CHECK(length(surface.at({f, patch, 1, 0}).p -
                             (cage.at(face, patch) + cage.at(face, (patch + 1) % 3)) * 0.5f) <
                      1e-6f);
            }
        }
    }
}
