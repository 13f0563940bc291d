#include <algorithm>

#include "renderer/api/image.h"

namespace tessera {
namespace {

constexpr float kEmptyDepth = 1e10f;

bool is_depth(const Layer& layer) {
    return layer.channels.size() == 1 && layer.channels[0] == "Z" && layer.kind == LayerKind::data;
}

Layer reframe(const Layer& layer, const PixelWindow& from, const PixelWindow& to) {
    const auto channels = static_cast<std::size_t>(layer.channels.size());
    Layer out{layer.name, layer.channels, layer.kind, {}};
    out.pixels.resize(
        static_cast<std::size_t>(to.width()) * static_cast<std::size_t>(to.height()) * channels,
        is_depth(layer) ? kEmptyDepth : 0.0f);
    const int x0 = std::max(from.x0, to.x0), x1 = std::min(from.x1, to.x1);
    if (x0 >= x1) return out;
    for (int y = std::max(from.y0, to.y0); y < std::min(from.y1, to.y1); ++y) {
        const auto at = [&](const PixelWindow& w) {
            return (static_cast<std::size_t>(y - w.y0) * static_cast<std::size_t>(w.width()) +
                    static_cast<std::size_t>(x0 - w.x0)) *
                   channels;
        };
        std::copy_n(layer.pixels.data() + at(from), static_cast<std::size_t>(x1 - x0) * channels,
                    out.pixels.data() + at(to));
    }
    return out;
}

}  // namespace

LayeredImage reframe(const LayeredImage& image, const PixelWindow& window) {
    LayeredImage out;
    out.width = image.width;
    out.height = image.height;
    out.window = window;
    out.working_space = image.working_space;
    out.metadata = image.metadata;
    for (const Layer& layer : image.layers)
        out.layers.push_back(reframe(layer, image.window, window));
    return out;
}

}  // namespace tessera
