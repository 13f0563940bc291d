#pragma once
// How much of what a surface sends belongs to which event of the light paths.

#include "renderer/core/warp.h"
#include "renderer/integrator/apart.h"
#include "renderer/integrator/block.h"
#include "renderer/integrator/path_passes.h"
#include "renderer/integrator/shading.h"

namespace tessera {

/// Of what lane i sends of a light's sample toward wi (local); any unit.
template <Features F, class ApartOrNone>
EventColors light_shares(int i, const Lobes<F>& lobes, const ApartOrNone& apart, Vec3f wi,
                         const LightSamples& light) {
    if constexpr (F.apart) {
        if (apart.lanes() >> i & 1u) return apart.shares_of_light(i, lobes, wi, light);
    }
    return lobes.values(i, wi, LobePart::all);
}

/// Tells the passes by what events lane i goes on as sampled. smooth: a smooth lobe sent it.
template <Features F, class ApartOrNone>
void scatter_passes(PathPasses& passes, int i, const Lobes<F>& lobes, const ApartOrNone& apart,
                    Vec3f wi, bool smooth) {
    if (smooth) return passes.scatter(i, lobes.taken_event(i, wi));
    LobePart part = LobePart::all;
    if constexpr (F.apart) {
        if (apart.lanes() >> i & 1u)
            part = lobes.took_specular(i) ? LobePart::specular : LobePart::matte;
    }
    passes.scatter(i, lobes.values(i, wi, part));
}

/// What a surface that shines, or a sampled point on one, is to the passes.
inline LightLabel label_of(const Scene& scene, std::int32_t material, std::int32_t light) {
    if (material < 0) return scene.lights().label(light);
    return {LightType::object, scene.light_tags().of_material(material)};
}

/// Whether one ray from lane i about the normal, by the cosine, meets nothing in the pass's reach.
inline bool is_open(const BlockJob& job, const FacingFrames& frame, int i, Vec3f p, Vec3f p_error,
                    std::uint32_t seed, Counters& counters) {
    const Vec3f local =
        warp_cosine(sample_pair(job.seeds[i], job.index, dim::vertex(0, dim::kOcclusion)));
    const Vec3f wi = frame.shading(i).to_world(local);
    if (!same_side(wi, local, frame.guard[i])) return false;
    const double reach = job.scene->film().ao_distance;
    const Ray ray{ray_origin(p, p_error, frame.ng[i], frame.lift[i], wi, local), wi,
                  reach > 0 ? static_cast<float>(reach) : kInfinity};
    if (!traceable(ray.o, ray.d)) return true;
    ++counters.rays.shadow;
    return !job.scene->accel().occluded(ray, hash_combine(seed, 0x616fu));
}

}  // namespace tessera
