#include "renderer/film/probes.h"

namespace tessera {

Probes::Probes(const PixelWindow& window, std::uint64_t seed)
    : grid_(window, seed), sums_(3 * grid_.cells()), counts_(grid_.cells()) {}

void Probes::add(std::size_t cell, Color c) noexcept {
    sums_[3 * cell].add(static_cast<double>(c.x));
    sums_[3 * cell + 1].add(static_cast<double>(c.y));
    sums_[3 * cell + 2].add(static_cast<double>(c.z));
    ++counts_[cell];
}

void Probes::merge(const Probes& other, const PixelWindow& other_window) {
    other.grid_.each_inside(other_window, [&](std::size_t from, ProbeGrid::Pixel p) {
        const std::size_t to = grid_.cell_of(p);
        for (std::size_t c = 0; c < 3; ++c) sums_[3 * to + c].add(other.sums_[3 * from + c]);
        counts_[to] += other.counts_[from];
    });
}

}  // namespace tessera
