#pragma once
// Every ray of a render, in the order and grouping in which Embree was asked, so that Embree alone
// can be timed on the very same work.

#include <cstdint>
#include <vector>

#include "renderer/core/ray.h"
#include "renderer/geometry/accel.h"

namespace tessera {

class RayLog {
public:
    void packet(const RayPacket& rays, LaneMask lanes, const std::uint32_t (&seeds)[kLanes],
                bool shadow);
    void single(const Ray& ray, std::uint32_t seed, bool shadow);
    std::uint64_t rays() const noexcept { return rays_; }
    /// Asks again; returns the number of hits, so that nothing is optimised away.
    std::uint64_t replay(const Accel& accel) const;

private:
    struct Packet {
        RayPacket rays;
        std::uint32_t seeds[kLanes];
        LaneMask lanes;
        bool shadow;
    };
    struct Single {
        Ray ray;
        std::uint32_t seed;
        bool shadow;
    };
    std::vector<Packet> packets_;
    std::vector<Single> singles_;
    std::vector<bool> order_;  // true: a packet comes next
    std::uint64_t rays_ = 0;
};

}  // namespace tessera
