#pragma once
// Large pictures behind OpenImageIO's tile cache: bounded memory, ten to twenty times slower per
// look-up than a pyramid. The library locks inside; nothing of ours does.

#include <cstdint>
#include <memory>
#include <string>

#include "renderer/image/texture.h"

namespace tessera {

class TileCache {
public:
    TileCache();
    ~TileCache();
    TileCache(const TileCache&) = delete;
    TileCache& operator=(const TileCache&) = delete;

    /// channels: what pick_channels() keeps of the file (1 grey, 2 grey and alpha, 3 RGB, 4 RGBA),
    /// the first ones of it. Returns a handle for sample(). Throws Error(ExitCode::scene).
    int add(const std::string& path, int channels, bool srgb);

    /// Trilinear look-up, v upward; width_u and width_v: footprint in units of u and v. For srgb
    /// pictures the curve is applied to the filtered value: mip levels there are means of codes,
    /// not of light, so that contrasty pictures get up to a fifth too dark at a distance.
    /// Unreadable tiles give magenta.
    Texel sample(int handle, float u, float v, float width_u, float width_v, Wrap wrap_u,
                 Wrap wrap_v) const noexcept;
    /// Estimate from a 16 x 16 grid of coarse look-ups.
    Texel mean(int handle) const noexcept;
    std::int64_t memory_bytes() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
