#pragma once
// One open picture: checked header, then its rows in the type the caller stores. What image_io and
// the texture store share.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "renderer/image/image_format.h"
#include "renderer/image/image_io.h"

namespace tessera {

class PixelReader {
public:
    /// Throws Error(ExitCode::scene) like image_info().
    PixelReader(const std::string& path, const ImageLimits& limits);
    ~PixelReader();
    PixelReader(const PixelReader&) = delete;
    PixelReader& operator=(const PixelReader&) = delete;

    const ImageInfo& info() const noexcept;
    ImageFormat format() const noexcept;
    /// Index of the alpha channel, -1 if none is marked.
    int alpha_channel() const noexcept;
    /// True if colours were multiplied by alpha before they were stored.
    bool premultiplied() const noexcept;

    /// Calls sink(first row, values) from top to bottom with whole rows of interleaved channels:
    /// float as image_io gives them, or the bytes of an 8-bit file. Throws Error on damage.
    void read_floats(const std::function<void(int, std::span<const float>)>& sink);
    void read_bytes(const std::function<void(int, std::span<const std::uint8_t>)>& sink);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
