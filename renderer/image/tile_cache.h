#pragma once
// Pictures that memory is too small for, behind OpenImageIO's tile cache: bounded memory, some ten
// times slower per look-up than a pyramid. The library locks inside; nothing of ours does.

#include <cstdint>
#include <memory>
#include <string>

#include "renderer/image/pyramid.h"
#include "renderer/image/texture.h"

namespace tessera {

class TileCache {
public:
    /// The library takes no less than 10 MiB. `tables` must outlive the cache.
    TileCache(std::int64_t bytes, const ByteTables& tables);
    ~TileCache();
    TileCache(const TileCache&) = delete;
    TileCache& operator=(const TileCache&) = delete;

    /// channels: what pick_channels() keeps of the file (1 grey, 2 grey and alpha, 3 RGB, 4 RGBA),
    /// the first ones of it. srgb: texels are decoded by the curve before they are filtered, so
    /// that only the means in the file's coarser levels can be those of codes. Returns a handle for
    /// sample(). Throws Error(ExitCode::scene).
    int add(const std::string& path, int channels, bool srgb);

    /// As filter_pyramid(), of the same bits where file and pyramid hold the same texels. Texels
    /// that are not finite read as 0. A tile that cannot be read gives magenta and is counted.
    Texel sample(int handle, TextureFilter filter, float u, float v, float level, Wrap wrap_u,
                 Wrap wrap_v, std::uint32_t seed) const noexcept;
    /// Of a .tx as its pyramid had it; else an estimate from a 16 x 16 grid of coarse look-ups.
    Texel mean(int handle) const noexcept;
    /// False if not known.
    bool channel_is_one(int handle, int c) const noexcept;

    std::int64_t memory_bytes() const noexcept;
    /// Read from files so far, decoded.
    std::int64_t bytes_read() const noexcept;
    /// Look-ups that met a tile that cannot be read.
    std::int64_t failures() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
