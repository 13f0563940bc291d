#pragma once
// Rays and hits: one, and sixteen at a time in the layout that Embree's packets have.

#include <cstdint>
#include <type_traits>

#include "renderer/core/vec.h"

namespace tessera {

inline constexpr int kLanes = 16;
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// Ray masks: things hidden from the camera do not carry the first bit.
inline constexpr std::uint32_t kCameraRays = 1u;
inline constexpr std::uint32_t kOtherRays = 2u;

struct Ray {
    Vec3f o;
    Vec3f d;  // need not be of unit length
    float t_max = kInfinity;
    std::uint32_t mask = kOtherRays;
};

/// Ids, not pointers: what Embree says was hit, and where on the primitive.
struct Hit {
    std::uint32_t prim = kNone;
    std::uint32_t geom = kNone;
    std::uint32_t inst = kNone;
    float u = 0, v = 0;
    float t = kInfinity;    // last bits may depend on packet or single ray; never reaches a pixel
    bool far_side = false;  // of a cut-out, for the opacity test: the wall that faces away
    bool valid() const { return geom != kNone; }
};

/// Sixteen rays, Embree's RTCRay16 (checked by static_assert where Embree is seen).
struct alignas(64) RayPacket {
    float ox[kLanes], oy[kLanes], oz[kLanes], t_min[kLanes];
    float dx[kLanes], dy[kLanes], dz[kLanes], time[kLanes];
    float t_max[kLanes];
    std::uint32_t mask[kLanes], id[kLanes], flags[kLanes];

    void set(int lane, const Ray& r) {
        ox[lane] = r.o.x, oy[lane] = r.o.y, oz[lane] = r.o.z, t_min[lane] = 0;
        dx[lane] = r.d.x, dy[lane] = r.d.y, dz[lane] = r.d.z, time[lane] = 0;
        t_max[lane] = r.t_max;
        mask[lane] = r.mask, id[lane] = static_cast<std::uint32_t>(lane), flags[lane] = 0;
    }
    Ray get(int lane) const {
        return {{ox[lane], oy[lane], oz[lane]},
                {dx[lane], dy[lane], dz[lane]},
                t_max[lane],
                mask[lane]};
    }
};

/// Sixteen rays with their hits, Embree's RTCRayHit16.
struct alignas(64) HitPacket {
    RayPacket ray;
    float ng_x[kLanes], ng_y[kLanes], ng_z[kLanes];
    float u[kLanes], v[kLanes];
    std::uint32_t prim[kLanes], geom[kLanes], inst[kLanes];

    Hit hit(int lane) const {
        return {prim[lane], geom[lane], inst[lane], u[lane], v[lane], ray.t_max[lane]};
    }
};

/// A vector per lane, by components: what all lanes do alike is done in loops over these, which the
/// compiler vectorises. They run over idle lanes too, that nobody wrote: what comes of those is
/// read by nobody.
struct alignas(64) Vec3Lanes {
    float x[kLanes], y[kLanes], z[kLanes];
    Vec3f operator[](int lane) const {
        return {x[lane], y[lane], z[lane]};  // NOLINT(clang-analyzer-core.CallAndMessage): idle
    }
    void set(int lane, Vec3f v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
};

/// A value per lane, not there until it is written: what a block never reads it need not clear.
template <class T>
class Lanes {
public:
    static_assert(std::is_trivially_destructible_v<T>);
    Lanes() {}
    T& operator[](int lane) { return values[lane]; }
    const T& operator[](int lane) const { return values[lane]; }
    using Array = T[kLanes];
    Array& array() { return values; }

private:
    union {
        T values[kLanes];
    };
};

/// One bit per lane.
using LaneMask = std::uint32_t;
inline constexpr LaneMask kAllLanes = 0xffffu;

/// Yes or no per lane as the vectorised loops write it: 1 or 0.
struct LaneFlags {
    std::uint32_t is[kLanes];
    LaneMask mask() const {
        LaneMask m = 0;
        for (int i = 0; i < kLanes; ++i) m |= is[i] << i;
        return m;
    }
};

inline LaneFlags flags_of(LaneMask lanes) {
    LaneFlags flags;
    for (int i = 0; i < kLanes; ++i) flags.is[i] = (lanes >> i) & 1u;
    return flags;
}

}  // namespace tessera
