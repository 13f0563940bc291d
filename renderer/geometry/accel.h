#pragma once
// Embree's BVHs behind two questions: what does a ray hit, and is anything in its way.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "renderer/core/ray.h"
#include "renderer/geometry/shapes.h"

namespace tessera {

/// Asked for each hit on a cut-out part: does the ray stop here? Must depend on its arguments only
/// (Embree may ask twice for one hit). d: the ray's direction in the space of the hit shape. seed:
/// the path's own number, see Accel::intersect.
struct OpacityTest {
    const void* scene = nullptr;
    bool (*stops)(const void* scene, const Hit& hit, Vec3f d,
                  std::uint32_t seed) noexcept = nullptr;
};

struct AccelOptions {
    int threads = 1;
    std::string isa;  // Embree's device option, "" = the best there is
    OpacityTest opacity;
};

/// What a hit means: the placement and the part of its mesh.
struct HitTarget {
    std::uint32_t placement = 0;
    std::uint32_t part = 0;
};

class Accel {
public:
    /// Builds; call inside the workers' arena. Throws Error(memory) or Error(bug). geometry must
    /// outlive this.
    Accel(const Geometry& geometry, const AccelOptions& options);
    ~Accel();
    Accel(const Accel&) = delete;
    Accel& operator=(const Accel&) = delete;

    /// Nearest hit of one ray. The ray has been checked by traceable(). seed feeds the opacity
    /// test.
    void intersect(const Ray& ray, std::uint32_t seed, Hit& hit) const noexcept;
    Hit intersect(const Ray& ray, std::uint32_t seed) const noexcept {
        Hit hit;
        intersect(ray, seed, hit);
        return hit;
    }
    /// The same for the lanes of a packet; hits are left in the packet. Bits of a lane do not
    /// depend on the others.
    void intersect(HitPacket& rays, LaneMask lanes,
                   const std::uint32_t (&seeds)[kLanes]) const noexcept;
    bool occluded(const Ray& ray, std::uint32_t seed) const noexcept;
    /// Lanes of `lanes` that are blocked. Rays are consumed.
    LaneMask occluded(RayPacket& rays, LaneMask lanes,
                      const std::uint32_t (&seeds)[kLanes]) const noexcept;

    HitTarget target(const Hit& hit) const noexcept {
        const bool instanced = hit.inst != kNone;
        const HitTarget slot = slots_[instanced ? hit.inst : hit.geom];
        return instanced ? HitTarget{slot.placement, hit.geom} : slot;
    }

    std::int64_t bytes() const noexcept;
    const std::string& isa() const noexcept { return isa_; }
    /// Version of the Embree that is linked, "3.13.5".
    static std::string version();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    std::vector<HitTarget> slots_;
    std::string isa_;
};

}  // namespace tessera
