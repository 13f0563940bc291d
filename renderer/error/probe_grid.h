#pragma once
// Which pixels are rendered a second time: one of every 8x4, at random.

#include <cstddef>
#include <cstdint>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// Cells over a window, rows from the top; they start at multiples of their size in the frame, so
/// that a crop has the probes of the whole.
class ProbeGrid {
public:
    static constexpr int kWidth = 8, kHeight = 4;

    struct Pixel {
        int x = 0, y = 0;
    };

    ProbeGrid() = default;
    ProbeGrid(const PixelWindow& window, std::uint64_t seed);

    std::size_t cells() const noexcept { return across_ * down_; }
    /// The probe of a cell, absolute in the frame. Of a cell at the window's edge it may lie
    /// outside.
    Pixel probe(std::size_t cell) const noexcept;
    /// Of a pixel within the window.
    std::size_t cell_of(Pixel p) const noexcept;
    /// Calls visit(cell, probe) for the probes within a part of the window.
    template <class Visit>
    void each_inside(const PixelWindow& part, Visit visit) const {
        if (cells() == 0 || part.x0 >= part.x1 || part.y0 >= part.y1) return;
        const std::size_t first = cell_of({part.x0, part.y0}),
                          last = cell_of({part.x1 - 1, part.y1 - 1});
        for (std::size_t row = first / across_; row <= last / across_; ++row) {
            for (std::size_t column = first % across_; column <= last % across_; ++column) {
                const std::size_t cell = row * across_ + column;
                const Pixel p = probe(cell);
                if (p.x >= part.x0 && p.x < part.x1 && p.y >= part.y0 && p.y < part.y1)
                    visit(cell, p);
            }
        }
    }

private:
    std::uint64_t seed_ = 0;
    int first_x_ = 0, first_y_ = 0;  // cells in the frame
    std::size_t across_ = 0, down_ = 0;
};

/// Of a probe's second rendering.
std::uint64_t probe_seed(std::uint64_t seed) noexcept;

}  // namespace tessera
