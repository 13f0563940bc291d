#include <bit>
#include <new>

#include "renderer/geometry/mesh_point.h"

namespace tessera {
namespace {

// What the arithmetic of a block of mesh points reads and makes; on one object, so that the
// compiler knows the arrays apart.
struct MeshPoints {
    Vec3Lanes a, b, c, na, nb, nc;
    float wa[kLanes], wb[kLanes], wc[kLanes];
    Vec3Lanes x, y, z, translation;  // of to_world
    float condition[kLanes];
    Vec3Lanes p, p_error, ng, ns, lift;

    void gather(int i, const FaceCorners& f) {
        a.set(i, f.a), b.set(i, f.b), c.set(i, f.c);
        na.set(i, f.na), nb.set(i, f.nb), nc.set(i, f.nc);
        wa[i] = f.wa, wb[i] = f.wb, wc[i] = f.wc;
    }
    void gather(int i, const Placement& placed) {
        const Affinef& m = placed.to_world;
        x.set(i, m.x), y.set(i, m.y), z.set(i, m.z), translation.set(i, m.p);
        condition[i] = placed.condition;
    }
    [[gnu::flatten]] void compute() {
        for (int i = 0; i < kLanes; ++i)
            set(i, mesh_point({a[i], b[i], c[i], na[i], nb[i], nc[i], wa[i], wb[i], wc[i]}));
    }
    [[gnu::flatten]] void place() {
        for (int i = 0; i < kLanes; ++i)
            set(i, to_world({x[i], y[i], z[i], translation[i]}, condition[i],
                            {p[i], p_error[i], ng[i], ns[i], lift[i]}));
    }
    void write(LaneMask lanes, SurfacePoint (&out)[kLanes]) const {
        for (LaneMask m = lanes; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            put({p[i], p_error[i], ng[i], ns[i], lift[i]}, out[i]);
        }
    }

private:
    void set(int i, const Point& at) {
        p.set(i, at.p), p_error.set(i, at.p_error), ng.set(i, at.ng), ns.set(i, at.ns);
        lift.set(i, at.lift);
    }
};

}  // namespace

void surface_points(const Geometry& geometry, LaneMask lanes, const HitTarget (&targets)[kLanes],
                    const Hit (&hits)[kLanes], const Ray (&rays)[kLanes], bool colors,
                    SurfacePoint (&out)[kLanes]) noexcept {
    MeshPoints points;
    LaneMask direct = 0, instanced = 0;
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        const Placement& placed = geometry.placements[targets[i].placement];
        if (placed.kind != PlacedKind::mesh) {
            new (&out[i])
                SurfacePoint(surface_point(geometry, targets[i], hits[i], rays[i], colors));
            continue;
        }
        const Mesh& mesh = geometry.meshes[placed.shape];
        SurfacePoint& s = *new (&out[i]) SurfacePoint;
        name_mesh_hit(placed, mesh, targets[i], hits[i], s);
        points.gather(i, face_corners(mesh, s.face, hits[i], colors, s.vertex_color));
        if (placed.instanced) points.gather(i, placed);
        (placed.instanced ? instanced : direct) |= 1u << i;
    }
    points.compute();
    points.write(direct, out);
    if (instanced == 0) return;
    points.place();
    points.write(instanced, out);
}

}  // namespace tessera
