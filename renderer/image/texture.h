#pragma once
// Filtered texture look-ups. Images live in memory as mip pyramids (8-bit with a decode table,
// 16-bit, or half floats); those over kInCoreBytes go through OpenImageIO's tile cache. One
// interface: the caller does not see which.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/api/scene_desc.h"

namespace tessera {

class ColorSpaces;
class Workers;

/// What the shading system reads a texture as; decides the default colour space: raw for data; for
/// colour sRGB in integer files and lin_rec709 in float ones (.exr, .hdr).
enum class TextureUse : std::uint8_t { color, data };

struct TextureRequest {
    const TextureDesc* desc = nullptr;
    TextureUse use = TextureUse::color;
};

/// RGBA; channels a file lacks: grey is spread over RGB, alpha is 1.
using Texel = std::array<float, 4>;

class TextureStore {
public:
    static constexpr std::int64_t kInCoreBytes = std::int64_t(64) << 20;

    /// Loads, in parallel if workers are given; results never depend on it. An unreadable file is
    /// reported once through problems.warn and becomes a magenta 1x1; NaN and infinite texels
    /// become 0 and are counted in the warning; an unknown colour space is a problems.error.
    /// `colors` must outlive the store.
    TextureStore(const std::vector<TextureRequest>& requests, const ColorSpaces& colors,
                 Problems& problems, Workers* workers = nullptr);
    ~TextureStore();
    TextureStore(const TextureStore&) = delete;
    TextureStore& operator=(const TextureStore&) = delete;

    /// Value at (u, v), v upward (v = 0 is the bottom row), after the texture's placement, wrap,
    /// gain and bias (the last two on RGB only; Wrap::black gives 0 outside, in alpha too if the
    /// file has one). width: footprint in uv units (the larger axis of the pixel's cone), 0 = the
    /// finest level; trilinear between levels, bilinear within. Linear working-space colour for
    /// TextureUse::color. Finite for any input (non-finite uv read as 0). Thread-safe.
    Texel sample(int texture, float u, float v, float width) const noexcept;

    int size() const noexcept;
    /// Mean over the image, RGBA, with gain and bias (for light importance and folding). An
    /// estimate from coarse levels for images in the tile cache.
    Texel mean(int texture) const noexcept;
    /// True if every texel of channel c (0..3) equals 1: an alpha that cuts nothing out. False if
    /// not known (channels of the tile cache).
    bool channel_is_one(int texture, int c) const noexcept;
    bool has_alpha(int texture) const noexcept;
    std::int64_t memory_bytes() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
