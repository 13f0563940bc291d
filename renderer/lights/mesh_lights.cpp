#include "renderer/lights/mesh_lights.h"

#include <bit>
#include <cmath>

#include "renderer/core/robust.h"
#include "renderer/core/warp.h"

namespace tessera {
namespace {

// The faces that were chosen, and points on them as seen from the references.
struct FaceSamples {
    Vec3Lanes a, ab, ac, ref;
    float share[kLanes], u[kLanes], v[kLanes];
    Vec3Lanes p, p_error, n, wi;
    float b0[kLanes], b1[kLanes], pdf[kLanes];
    LaneFlags there;

    void choose(int i, const MeshLight& light, Vec3f from, Vec2f at, LightSamples& out) {
        const AliasTable::Pick pick =
            light.faces->pick.sample(at.x, hash_u32(std::bit_cast<std::uint32_t>(at.y)));
        const EmissiveFaces::Triangle& t = light.faces->triangles[pick.index];
        a.set(i, t.a), ab.set(i, t.ab), ac.set(i, t.ac);
        ref.set(i, from);
        share[i] = pick.probability, u[i] = pick.remainder, v[i] = at.y;
        out.material[i] = t.material;
        out.placement[i] = light.placement;
        const Vec2f b = warp_triangle({u[i], v[i]});
        out.uv[i] = t.ta + t.tab * b.x + t.tac * b.y;
    }

    [[gnu::flatten]] void place() {
        for (int i = 0; i < kLanes; ++i) {
            const Vec2f b = warp_triangle({u[i], v[i]});
            const Vec3f at = a[i] + ab[i] * b.x + ac[i] * b.y;
            p_error.set(i, abs(a[i]) * gamma_bound(9) + (abs(ab[i]) + abs(ac[i])) * gamma_bound(9));
            const Vec3f across = cross(ab[i], ac[i]);
            const float twice_area = length(across);
            const Vec3f normal = across / twice_area, d = at - ref[i];
            const float d2 = length2(d);
            const Vec3f toward = d / std::sqrt(d2);
            const float cos = std::fabs(dot(normal, toward));
            const float density = 2.0f * share[i] / twice_area * d2 / cos;
            p.set(i, at);
            n.set(i, normal);
            wi.set(i, toward);
            pdf[i] = density;
            there.is[i] = (twice_area > 0.0f) & (d2 > 0.0f) & (cos > 1e-7f) & (density < kInfinity);
        }
    }
};

}  // namespace

LaneMask sample_mesh_lights(LaneMask lanes, const Light* const (&lights)[kLanes],
                            const LightReference (&refs)[kLanes], const SamplePairs& u,
                            LightSamples& out) noexcept {
    FaceSamples s;
    LaneMask here = 0, made = 0;
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        const MeshLight& light = *std::get_if<MeshLight>(lights[i]);
        if (!light.placed) {
            s.choose(i, light, refs[i].p, u.at(i), out);
            here |= 1u << i;
            continue;
        }
        LightSample one;
        if (!sample_light(*lights[i], refs[i], u.at(i), one)) continue;
        out.set(i, one);
        made |= 1u << i;
    }
    if (here == 0) return made;
    s.place();
    here &= s.there.mask();
    for (LaneMask m = here; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        out.p.set(i, s.p[i]), out.p_error.set(i, s.p_error[i]);
        out.n.set(i, s.n[i]), out.wi.set(i, s.wi[i]);
        out.radiance.set(i, Color(0.0f));
        out.pdf[i] = s.pdf[i];
        out.delta[i] = out.infinite[i] = out.surroundings[i] = 0;
    }
    return made | here;
}

}  // namespace tessera
