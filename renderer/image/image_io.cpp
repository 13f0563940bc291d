#include "renderer/image/image_io.h"

#include <new>

#include "renderer/api/error.h"
#include "renderer/image/pixel_reader.h"

namespace tessera {

ImageInfo image_info(const std::string& path, const ImageLimits& limits) {
    return PixelReader(path, limits).info();
}

Image read_image(const std::string& path, const ImageLimits& limits) {
    PixelReader reader(path, limits);
    const ImageInfo& info = reader.info();
    const std::int64_t values = std::int64_t(info.width) * info.height * info.channels;
    if (values > limits.max_bytes / std::int64_t(sizeof(float)))
        fail_image(path, "it needs " + std::to_string(values * 4 >> 20) +
                             " MiB as floats, more than the limit of " +
                             std::to_string(limits.max_bytes >> 20) + " MiB");
    Image image;
    image.width = info.width;
    image.height = info.height;
    image.channels = info.channels;
    try {
        image.pixels.reserve(static_cast<std::size_t>(values));
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, "image '" + path + "': cannot read: out of memory");
    }
    // Reserved but not touched: a file that lies about its size fails before the memory is real.
    reader.read_floats([&](int, std::span<const float> rows) {
        image.pixels.insert(image.pixels.end(), rows.begin(), rows.end());
    });
    return image;
}

}  // namespace tessera
