#include "renderer/integrator/tiles.h"

#include <algorithm>
#include <cstdint>

namespace tessera {
namespace {

// Downward also left of and above the frame, where overscan is.
int tile_of(int pixel, int size) {
    return pixel >= 0 ? pixel / size : -((size - 1 - pixel) / size);
}

// Place of cell (x, y) along the Hilbert curve of a 2^order grid.
std::uint64_t hilbert_index(std::uint32_t x, std::uint32_t y, int order) {
    std::uint64_t d = 0;
    for (std::uint32_t s = 1u << (order - 1); s > 0; s >>= 1) {
        const std::uint32_t rx = (x & s) ? 1 : 0, ry = (y & s) ? 1 : 0;
        d += std::uint64_t(s) * s * ((3 * rx) ^ ry);
        if (ry == 0) {
            if (rx == 1) x = s - 1 - (x & (s - 1)), y = s - 1 - (y & (s - 1));
            std::swap(x, y);
        }
        x &= s - 1, y &= s - 1;
    }
    return d;
}

}  // namespace

std::vector<PixelWindow> make_tiles(const PixelWindow& window, int size) {
    const int tx0 = tile_of(window.x0, size), ty0 = tile_of(window.y0, size);
    const int tx1 = tile_of(window.x1 - 1, size) + 1, ty1 = tile_of(window.y1 - 1, size) + 1;
    int order = 1;
    while ((1 << order) < std::max(tx1 - tx0, ty1 - ty0)) ++order;
    std::vector<std::pair<std::uint64_t, PixelWindow>> keyed;
    for (int ty = ty0; ty < ty1; ++ty) {
        for (int tx = tx0; tx < tx1; ++tx) {
            const PixelWindow t{std::max(tx * size, window.x0), std::max(ty * size, window.y0),
                                std::min((tx + 1) * size, window.x1),
                                std::min((ty + 1) * size, window.y1)};
            keyed.push_back({hilbert_index(static_cast<std::uint32_t>(tx - tx0),
                                           static_cast<std::uint32_t>(ty - ty0), order),
                             t});
        }
    }
    std::sort(keyed.begin(), keyed.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<PixelWindow> tiles;
    for (const auto& [key, tile] : keyed) tiles.push_back(tile);
    return tiles;
}

}  // namespace tessera
