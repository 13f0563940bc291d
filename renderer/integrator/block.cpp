#include "renderer/integrator/block.h"

#include <algorithm>
#include <tuple>

#include "renderer/core/sampler.h"

namespace tessera {

void Counters::add_invalid(InvalidCause cause, int x, int y, std::uint32_t sample) noexcept {
    ++invalid[static_cast<int>(cause)];
    // The first in (sample, y, x) order, so that what is reported does not depend on threads.
    if (!first.set || std::tuple(sample, y, x) < std::tuple(first.sample, first.y, first.x)) {
        first = {true, cause, x, y, sample};
    }
}

void Counters::add(const Counters& o) noexcept {
    rays.camera += o.rays.camera;
    rays.bounce += o.rays.bounce;
    rays.shadow += o.rays.shadow;
    samples += o.samples;
    for (int i = 0; i < kInvalidCauses; ++i) invalid[i] += o.invalid[i];
    if (o.first.set && (!first.set || std::tuple(o.first.sample, o.first.y, o.first.x) <
                                          std::tuple(first.sample, first.y, first.x))) {
        first = o.first;
    }
}

LaneMask lanes_inside(const PixelWindow& w, int x, int y) noexcept {
    LaneMask lanes = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
        const int px = x + (lane & 3), py = y + (lane >> 2);
        if (px >= w.x0 && px < w.x1 && py >= w.y0 && py < w.y1) lanes |= 1u << lane;
    }
    return lanes;
}

BlockSeeds block_seeds(const BlockJob& job, std::uint64_t seed) noexcept {
    BlockSeeds out;
    for (int lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t pixel = pixel_seed(lane_x(job, lane), lane_y(job, lane), seed);
        for (std::uint32_t r = 0; r < kReplicates; ++r) out.of[r][lane] = hash_combine(pixel, r);
    }
    return out;
}

void choose_sample(BlockJob& job, const BlockSeeds& seeds, std::uint32_t sample) noexcept {
    job.sample = sample;
    job.index = sample / kReplicates;
    std::copy_n(seeds.of[sample % kReplicates], kLanes, job.seeds);
}

void film_points(const BlockJob& job, SamplePairs& out) noexcept {
    SamplePairs u;
    sample_pairs(job.seeds, job.index, dim::kFilter, u);
    for (int lane = 0; lane < kLanes; ++lane) {
        const Vec2f offset = job.filter->offset(u.at(lane));
        out.x[lane] = static_cast<float>(lane_x(job, lane)) + 0.5f + offset.x;
        out.y[lane] = static_cast<float>(lane_y(job, lane)) + 0.5f + offset.y;
    }
}

}  // namespace tessera
