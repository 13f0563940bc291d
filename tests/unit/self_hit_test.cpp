#include <doctest/doctest.h>

#include <random>

#include "renderer/core/robust.h"
#include "renderer/core/warp.h"
#include "renderer/geometry/accel.h"
#include "renderer/geometry/interpolate.h"

using namespace tessera;

namespace {

// Rays leaving random points of random faces: how many run into the face they left.
struct Probe {
    float size = 1;      // of the faces
    float distance = 0;  // of the faces from the origin
    bool axis_planes = false;
    bool quads = false;
    bool instanced = false;
};

Geometry one_face(const Probe& probe, std::mt19937& rng) {
    std::uniform_real_distribution<float> u(-1, 1);
    const Vec3f at{u(rng) * probe.distance, u(rng) * probe.distance, u(rng) * probe.distance};
    const auto corner = [&] {
        Vec3f p{u(rng) * probe.size, u(rng) * probe.size, u(rng) * probe.size};
        if (probe.axis_planes) p.y = 0;
        return at + p;
    };
    Mesh mesh;
    const Vec3f a = corner(), b = corner(), c = corner();
    mesh.materials = {0};
    mesh.add_vertex(a);
    mesh.add_vertex(b);
    if (probe.quads) mesh.add_vertex(a + (b - a) * 0.9f + (c - a));
    mesh.add_vertex(c);
    mesh.finish_vertices();
    mesh.index =
        probe.quads ? std::vector<std::uint32_t>{0, 1, 2, 3} : std::vector<std::uint32_t>{0, 1, 2};
    ++(probe.quads ? mesh.quads : mesh.triangles);
    mesh.parts = {{0, 1, probe.quads, false}};
    Geometry g;
    g.meshes.push_back(mesh);
    Placement placed;
    placed.material = 0;
    if (probe.instanced) {
        placed.instance_at(
            Affined(Affinef({u(rng), u(rng), u(rng)}, {u(rng), u(rng), u(rng)},
                            {u(rng), u(rng), u(rng)}, {u(rng) * probe.distance, 0, u(rng)})));
    }
    g.placements.push_back(placed);
    return g;
}

// Faces with an aspect beyond 50 have a plane that single precision does not know; they are the
// stress suite's matter.
bool fair(const Geometry& g) {
    const Mesh& mesh = g.meshes[0];
    const Vec3f e1 = mesh.position(1) - mesh.position(0), e2 = mesh.position(2) - mesh.position(0);
    const float longest = std::fmax(length2(e1), std::fmax(length2(e2), length2(e2 - e1)));
    const Affinef& m = g.placements[0].to_world;
    const float stretch = std::fmax(length(m.x), std::fmax(length(m.y), length(m.z)));
    return length(cross(e1, e2)) > 0.02f * longest &&
           std::fabs(m.determinant()) > 0.02f * stretch * stretch * stretch;
}

int self_hits(const Probe& probe, int faces, int rays) {
    std::mt19937 rng(11);
    std::uniform_real_distribution<float> u(0, 1);
    int hits = 0;
    for (int f = 0; f < faces; ++f) {
        const Geometry g = one_face(probe, rng);
        if (!fair(g)) continue;
        const Accel accel(g, {});
        for (int r = 0; r < rays; ++r) {
            Hit hit;
            hit.prim = 0, hit.geom = 0, hit.inst = probe.instanced ? 0 : kNone;
            const Vec2f b = warp_triangle({u(rng), u(rng)});
            hit.u = b.x, hit.v = b.y;
            const SurfacePoint s = surface_point(g, accel.target(hit), hit, Ray{}, false);
            // From straight up to a hundredth of a degree above the face, on either side.
            const float cosine = std::pow(10.0f, -4.0f * u(rng));
            const SinCos a = sincos_turn(u(rng));
            const float sine = safe_sqrt(1 - cosine * cosine), side = u(rng) < 0.5f ? -1.0f : 1.0f;
            const Vec3f w = Frame(s.ng).to_world({sine * a.cos, sine * a.sin, cosine * side});
            const Ray ray{offset_origin(s.p, s.p_error, s.ng, w), w, kInfinity, kOtherRays};
            hits += accel.intersect(ray, 0).valid();
        }
    }
    return hits;
}

}  // namespace

TEST_CASE("self hits: no ray runs into the face it left") {
    for (const float size : {1e-3f, 1.0f, 1e4f}) {
        for (const float distance : {0.0f, 1.0f, 1e3f, 1e5f}) {
            for (const int kind : {0, 1, 2, 3, 4}) {
                const Probe probe{size, distance, kind == 1, kind == 2 || kind == 4, kind >= 3};
                CAPTURE(size);
                CAPTURE(distance);
                CAPTURE(kind);
                // A face smaller than the float grid where it lies has no plane at all.
                if (size < distance * 1e-4f) continue;
                CHECK(self_hits(probe, 40, 500) == 0);
            }
        }
    }
}
