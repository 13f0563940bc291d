#include "renderer/error/probe_grid.h"

#include "renderer/core/sampler.h"

namespace tessera {
namespace {

int floor_div(int a, int b) { return a >= 0 ? a / b : -((-a + b - 1) / b); }

constexpr std::uint64_t kPlaces = 0x9b1f3c5d7e2a4860u, kScrambles = 0x5851f42d4c957f2du;

}  // namespace

ProbeGrid::ProbeGrid(const PixelWindow& w, std::uint64_t seed)
    : seed_(seed), first_x_(floor_div(w.x0, kWidth)), first_y_(floor_div(w.y0, kHeight)) {
    if (w.x0 >= w.x1 || w.y0 >= w.y1) return;
    const int last_x = floor_div(w.x1 - 1, kWidth), last_y = floor_div(w.y1 - 1, kHeight);
    across_ = static_cast<std::size_t>(last_x - first_x_) + 1;
    down_ = static_cast<std::size_t>(last_y - first_y_) + 1;
}

ProbeGrid::Pixel ProbeGrid::probe(std::size_t cell) const noexcept {
    const int cx = first_x_ + static_cast<int>(cell % across_),
              cy = first_y_ + static_cast<int>(cell / across_);
    const std::uint32_t h = pixel_seed(cx, cy, seed_ ^ kPlaces);
    return {cx * kWidth + static_cast<int>(h % kWidth),
            cy * kHeight + static_cast<int>((h >> 16) % kHeight)};
}

std::size_t ProbeGrid::cell_of(Pixel p) const noexcept {
    return static_cast<std::size_t>(floor_div(p.y, kHeight) - first_y_) * across_ +
           static_cast<std::size_t>(floor_div(p.x, kWidth) - first_x_);
}

std::uint64_t probe_seed(std::uint64_t seed) noexcept { return seed + kScrambles; }

}  // namespace tessera
