#pragma once
// The smooth surface that a cage stands for, and its texture coordinates, at any point: the limit
// of Catmull and Clark, "Recursively generated B-spline surfaces on arbitrary topological meshes",
// 1978, as Embree evaluates it; or the cage itself, for scheme linear.

#include <cstdint>
#include <memory>
#include <string>

#include "renderer/geometry/dice.h"

namespace tessera {

struct LimitPoint {
    Vec3f p;       // about the cage's origin
    Vec3f ds, dt;  // along the patch; at an extraordinary corner only their directions count
    Vec3f n;       // unit, outward by the winding; of a linear cage its own, interpolated
    Vec2f uv, uv_ds, uv_dt;
};

class LimitSurface {
public:
    /// More faces at one place cannot be evaluated.
    static constexpr std::uint32_t kMaxValence = 63;

    /// mesh and cage must outlive this. threads, isa: as for Accel. Throws Error(memory) or
    /// Error(bug).
    LimitSurface(const MeshDesc& mesh, const Cage& cage, int threads, const std::string& isa);
    ~LimitSurface();
    LimitSurface(const LimitSurface&) = delete;
    LimitSurface& operator=(const LimitSurface&) = delete;

    LimitPoint at(const DiceSite& site) const noexcept;
    std::int64_t bytes() const noexcept;

private:
    LimitPoint limit(const DiceSite& site) const noexcept;
    LimitPoint straight(const DiceSite& site) const noexcept;

    struct Impl;
    const MeshDesc& mesh_;
    const Cage& cage_;
    std::unique_ptr<Impl> impl_;  // none: linear
};

}  // namespace tessera
