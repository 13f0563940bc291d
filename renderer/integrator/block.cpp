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

void Counters::add_rays(const RayCounts& more) noexcept {
    rays.camera += more.camera;
    rays.bounce += more.bounce;
    rays.shadow += more.shadow;
}

void Counters::add(const Counters& o) noexcept {
    add_rays(o.rays);
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

void aim_block(BlockJob& job, int x, int y, std::uint64_t seed) noexcept {
    for (int lane = 0; lane < kLanes; ++lane)
        aim_lane(job, lane, x + (lane & 3), y + (lane >> 2), seed);
}

void aim_lane(BlockJob& job, int lane, int x, int y, std::uint64_t seed) noexcept {
    job.x[lane] = x, job.y[lane] = y;
    job.seeds[lane] = pixel_seed(x, y, seed);
}

void choose_sample(BlockJob& job, std::uint32_t sample) noexcept {
    job.sample = sample;
    job.index = point_of_sample(sample);
}

void film_points(const BlockJob& job, SamplePairs& out) noexcept {
    SamplePairs u;
    sample_pairs(job.seeds, job.index, dim::kFilter, u);
    for (int lane = 0; lane < kLanes; ++lane) {
        const Vec2f offset = job.filter->offset(u.at(lane));
        out.x[lane] = static_cast<float>(job.x[lane]) + 0.5f + offset.x;
        out.y[lane] = static_cast<float>(job.y[lane]) + 0.5f + offset.y;
    }
}

}  // namespace tessera
