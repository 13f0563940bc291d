#pragma once
// The test that cut-out surfaces put to a ray.

#include <cstdint>

#include "renderer/core/ray.h"

namespace tessera {

/// OpacityTest::stops for a Scene. Partial opacity stops a ray with that probability, decided by a
/// hash of the path's seed and the primitive: the same answer however often it is asked.
bool opacity_stops(const void* scene, const Hit& hit, Vec3f d, std::uint32_t seed) noexcept;

}  // namespace tessera
