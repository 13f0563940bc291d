#include "renderer/integrator/ray_log.h"

#include <bit>
#include <cstring>

namespace tessera {

void RayLog::packet(const RayPacket& rays, LaneMask lanes, const std::uint32_t (&seeds)[kLanes],
                    bool shadow) {
    Packet p{rays, {}, lanes, shadow};
    std::memcpy(p.seeds, seeds, sizeof seeds);
    packets_.push_back(p);
    order_.push_back(true);
    rays_ += static_cast<std::uint64_t>(std::popcount(lanes));
}

void RayLog::single(const Ray& ray, std::uint32_t seed, bool shadow) {
    singles_.push_back({ray, seed, shadow});
    order_.push_back(false);
    ++rays_;
}

std::uint64_t RayLog::replay(const Accel& accel) const {
    std::uint64_t hits = 0;
    std::size_t packet = 0, single = 0;
    for (const bool is_packet : order_) {
        if (is_packet) {
            const Packet& p = packets_[packet++];
            if (p.shadow) {
                RayPacket rays = p.rays;
                hits += static_cast<std::uint64_t>(
                    std::popcount(accel.occluded(rays, p.lanes, p.seeds)));
            } else {
                HitPacket rays;
                rays.ray = p.rays;
                accel.intersect(rays, p.lanes, p.seeds);
                for (int i = 0; i < kLanes; ++i) hits += rays.geom[i] != kNone;
            }
        } else {
            const Single& s = singles_[single++];
            hits +=
                s.shadow ? accel.occluded(s.ray, s.seed) : accel.intersect(s.ray, s.seed).valid();
        }
    }
    return hits;
}

}  // namespace tessera
