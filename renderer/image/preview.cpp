#include <algorithm>
#include <new>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/image/atomic_file.h"
#include "renderer/image/colour_space.h"
#include "renderer/image/eight_bit.h"

namespace tessera {
namespace {

/// Root R,G,B over black. The colours are premultiplied, so leaving alpha out is all there is to
/// do, and a background with alpha 0 shows.
std::vector<float> beauty_of(const LayeredImage& image, const std::string& path) {
    const PixelWindow& w = image.window;
    for (const Layer& layer : image.layers) {
        std::size_t index[3];
        bool found = layer.name.empty();
        for (std::size_t c = 0; c < 3; ++c) {
            const auto at =
                std::find(layer.channels.begin(), layer.channels.end(), std::string(1, "RGB"[c]));
            found = found && at != layer.channels.end();
            index[c] = static_cast<std::size_t>(at - layer.channels.begin());
        }
        if (!found) continue;
        const std::size_t stride = layer.channels.size();
        if (w.x1 <= w.x0 || w.y1 <= w.y0 ||
            layer.pixels.size() !=
                static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height()) * stride)
            throw Error(ExitCode::bug, "write_preview: the beauty does not fill its window");
        std::vector<float> rgb(layer.pixels.size() / stride * 3);
        for (std::size_t i = 0; i < rgb.size(); ++i)
            rgb[i] = layer.pixels[i / 3 * stride + index[i % 3]];
        return rgb;
    }
    fail_output(path, "the picture has no beauty layer (R, G, B)");
}

}  // namespace

void write_preview(const LayeredImage& image, const std::string& path, const std::string& view) {
    check_eight_bit(path);
    try {
        std::vector<float> rgb = beauty_of(image, path);
        ColorSpaces(image.working_space).to_display(rgb, view);
        std::vector<unsigned char> pixels(rgb.size());
        std::transform(rgb.begin(), rgb.end(), pixels.begin(),
                       [](float v) { return static_cast<unsigned char>(v * 255 + 0.5f); });
        write_eight_bit(pixels, image.window.width(), image.window.height(), path);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, path + ": cannot write: out of memory");
    } catch (const std::exception& error) {
        fail_output(path, error.what());
    }
}

}  // namespace tessera
