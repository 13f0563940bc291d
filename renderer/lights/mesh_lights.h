#pragma once
// Emissive meshes for sixteen lanes at once.

#include "renderer/lights/light.h"

namespace tessera {

/// sample_light for mesh lights, each lane its own, with the same bits. Returns the lanes that got
/// a sample.
LaneMask sample_mesh_lights(LaneMask lanes, const Light* const (&lights)[kLanes],
                            const LightReference (&refs)[kLanes], const SamplePairs& u,
                            LightSamples& out) noexcept;

}  // namespace tessera
