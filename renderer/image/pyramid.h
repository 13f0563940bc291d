#pragma once
// A picture and its mip levels in memory, in the smallest type that keeps it, and look-ups in it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/image/texture.h"

namespace tessera {

class PixelReader;

enum class TexelType : std::uint8_t { byte, unorm16, half };

/// What the 256 codes of a byte mean.
struct ByteTables {
    ByteTables();
    std::array<float, 256> linear;
    std::array<float, 256> srgb;
};

/// Level k + 1 has half the size of level k, rounded down, at least 1; an area-weighted mean in
/// linear light. Colours that were not premultiplied are weighted by their alpha, so that what
/// cannot be seen does not bleed.
struct Pyramid {
    /// Texels lie in blocks of 8 x 8 (the last ones padded), so that the four of a bilinear look-up
    /// share a cache line or two and a page.
    struct Level {
        std::size_t first = 0;  // texel
        int width = 1;
        int height = 1;

        /// Texel (x, y) is number first + row(y) + column(x); row 0 is the top.
        std::size_t row(int y) const noexcept {
            const auto yy = static_cast<std::size_t>(y);
            return (yy >> 3) * (blocks(width) << 6) + ((yy & 7) << 3);
        }
        std::size_t column(int x) const noexcept {
            const auto xx = static_cast<std::size_t>(x);
            return ((xx >> 3) << 6) + (xx & 7);
        }
        std::size_t texels() const noexcept { return (blocks(width) * blocks(height)) << 6; }
        static std::size_t blocks(int n) noexcept { return (static_cast<std::size_t>(n) + 7) >> 3; }
    };

    TexelType type = TexelType::byte;
    int channels = 3;                    // 1 grey, 2 grey and alpha, 3 RGB, 4 RGBA
    const float* color_table = nullptr;  // bytes only; outlive the pyramid
    const float* alpha_table = nullptr;
    std::vector<Level> levels;
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint16_t> words;
    Texel mean{0, 0, 0, 1};
    std::array<bool, 4> is_one{false, false, false, true};
    std::size_t non_finite = 0;  // replaced by 0
    std::size_t clamped = 0;     // beyond half's 65504

    bool has_alpha() const noexcept { return channels == 2 || channels == 4; }
    std::int64_t memory_bytes() const noexcept;
};

/// Which channels of a file a pyramid keeps.
struct ChannelPick {
    std::array<int, 4> from{-1, -1, -1, -1};  // -1 = zero
    int count = 0;
};
ChannelPick pick_channels(int file_channels, int alpha_channel) noexcept;

/// color_space: the resolved name; a data space changes nothing. skip: finest levels that are left
/// out and never held; what remains is what it would be with them. Throws Error as the reader and
/// ColorSpaces::to_working do.
Pyramid build_pyramid(PixelReader& reader, const std::string& color_space,
                      const ColorSpaces& colors, const ByteTables& tables, int skip = 0);
/// One texel of a linear 8-bit colour.
Pyramid constant_pyramid(const std::array<std::uint8_t, 3>& rgb, const ByteTables& tables);

/// The stored type, known before anything is read.
TexelType texel_type(PixelReader& reader, const std::string& color_space,
                     const ColorSpaces& colors);
/// What build_pyramid() will keep of each texel: more than the pick where a conversion colours
/// grey.
int stored_channels(PixelReader& reader, const std::string& color_space, const ColorSpaces& colors);
/// Bytes of the texels of a pyramid of this size without its first `skip` levels.
std::int64_t pyramid_bytes(int width, int height, int channels, TexelType type, int skip = 0);

/// A finite coordinate brought near the picture, so that no texel number is too large for an int;
/// what it reads stays the same.
float fold(float u, Wrap wrap) noexcept;

/// Trilinear look-up; u to the right, v upward, level 0 the finest, clamped. u and v are finite.
Texel sample_pyramid(const Pyramid& pyramid, float u, float v, float level, Wrap wrap_u,
                     Wrap wrap_v) noexcept;

/// The same by any filter; trilinear gives the same bits, more slowly. seed decides what the
/// stochastic filter draws at (u, v).
Texel filter_pyramid(const Pyramid& pyramid, TextureFilter filter, float u, float v, float level,
                     Wrap wrap_u, Wrap wrap_v, std::uint32_t seed) noexcept;

}  // namespace tessera
