#pragma once
// How long Embree alone takes for the rays of a render.

#include "renderer/api/render.h"

namespace tessera {

struct ReplayTimes {
    double seconds = 0;  // wall, all threads, of Embree's calls and the copying of rays to them
    double cpu_seconds =
        0;  // of the whole process over the same stretches: steadier on a machine that is shared
    std::uint64_t rays = 0;
};

/// Renders tile by tile with every ray taken down, and times asking Embree again for the same rays,
/// in the same order, packets as packets. Tiles are recorded and replayed in turn so that memory
/// stays small; only the replay is timed.
ReplayTimes time_replay(const Scene& scene, const RenderSettings& settings);

}  // namespace tessera
