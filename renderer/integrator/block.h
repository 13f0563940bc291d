#pragma once
// The unit of work: sixteen pixels at one sample index, as a rule an aligned 4x4 block, absolute in
// the frame. A pixel's bits depend on nothing else: not on its neighbours, tile, crop or thread.

#include <array>
#include <cstdint>

#include "renderer/api/render.h"
#include "renderer/core/ray.h"
#include "renderer/core/sampler.h"
#include "renderer/film/film.h"
#include "renderer/film/filter.h"
#include "renderer/scene/scene.h"

namespace tessera {

inline constexpr int kBlockSize = 4;

class PathPasses;
class RayLog;

/// What one worker counts; added up at the end.
struct Counters {
    RayCounts rays;
    std::uint64_t samples = 0;
    std::array<std::uint64_t, kInvalidCauses> invalid{};
    struct First {
        bool set = false;
        InvalidCause cause{};
        int x = 0, y = 0;
        std::uint32_t sample = 0;
    } first;

    void add_invalid(InvalidCause cause, int x, int y, std::uint32_t sample) noexcept;
    void add_rays(const RayCounts& more) noexcept;
    void add(const Counters& other) noexcept;
};

struct BlockJob {
    const Scene* scene = nullptr;
    const FilterSampler* filter = nullptr;
    PathPasses* passes = nullptr;  // null: beauty alone
    LaneMask lanes = kAllLanes;
    int x[kLanes]{}, y[kLanes]{};   // the pixels
    std::uint32_t seeds[kLanes]{};  // of their scrambles
    std::uint32_t sample = 0;       // of each: the how manieth
    std::uint32_t index = 0;        // of its point
    RayLog* log = nullptr;          // takes down every ray, for the benchmark
};

using BlockSamples = std::array<PathSample, kLanes>;

/// Traces a block to the end of its paths.
using BlockKernel = void (*)(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept;

/// The kernel of a name ("basic", "surface", "full") for an integrator.
BlockKernel find_kernel(Integrator integrator, std::string_view name);

/// Sets pixels and seeds: of the block whose top left pixel is (x, y), multiples of 4.
void aim_block(BlockJob& job, int x, int y, std::uint64_t seed) noexcept;
void aim_lane(BlockJob& job, int lane, int x, int y, std::uint64_t seed) noexcept;
/// Sets sample and index.
void choose_sample(BlockJob& job, std::uint32_t sample) noexcept;

/// Numbers that decide partial opacity for the rays of one step.
inline void ray_seeds(const BlockJob& job, std::uint32_t step,
                      std::uint32_t (&seeds)[kLanes]) noexcept {
    const std::uint32_t salt = hash_combine(job.index, step);
    for (int i = 0; i < kLanes; ++i) seeds[i] = hash_combine(job.seeds[i], salt);
}

/// Where the samples of all lanes lie on the film, in pixels.
void film_points(const BlockJob& job, SamplePairs& out) noexcept;

/// Lanes of the block at (x, y) whose pixels lie in the window.
LaneMask lanes_inside(const PixelWindow& window, int x, int y) noexcept;

}  // namespace tessera
