#include "renderer/image/exr_layers.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>

#include <algorithm>
#include <new>
#include <string_view>

#include "renderer/image/exr_limits.h"
#include "renderer/image/image_format.h"
#include "renderer/image/working_space.h"

namespace tessera {
namespace {

constexpr std::string_view kOrder = "RGBAXYZWUV";  // the file's order is alphabetical

/// Channels in the order people expect; unknown names after, as in the file.
bool comes_before(const std::string& a, const std::string& b) {
    const auto rank = [](const std::string& name) {
        return name.size() == 1 ? kOrder.find(name[0]) : std::string_view::npos;
    };
    return rank(a) < rank(b);
}

bool is_beauty(const std::string& channel) {
    return channel.size() == 1 && kOrder.substr(0, 4).find(channel[0]) != std::string_view::npos;
}

/// A layer and how the file names its channels: with the layer's name before them, or bare.
struct StoredLayer {
    Layer layer;
    bool bare = false;

    std::string channel_name(std::size_t c) const {
        return bare ? layer.channels[c] : layer.name + "." + layer.channels[c];
    }
};

/// Layers without pixels, the root ones first. root: what bare channels are called.
std::vector<StoredLayer> group(const Imf::ChannelList& channels, const std::string& root,
                               const std::string& path) {
    std::vector<StoredLayer> layers;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const std::string full = it.name();
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1)
            fail_image(path, "channel '" + full + "' is subsampled, expected full resolution");
        const std::size_t dot = full.rfind('.');
        const bool bare = dot == std::string::npos;
        const std::string name = bare ? root : full.substr(0, dot);
        const std::string channel = bare ? full : full.substr(dot + 1);
        const LayerKind kind = it.channel().type == Imf::HALF ? LayerKind::color : LayerKind::data;
        const auto same = [&](const StoredLayer& other) {
            const Layer& layer = other.layer;
            return layer.name == name && other.bare == bare && layer.kind == kind &&
                   (!name.empty() || is_beauty(layer.channels[0]) == is_beauty(channel));
        };
        auto layer = std::find_if(layers.begin(), layers.end(), same);
        if (layer == layers.end())
            layer = layers.insert(layer, StoredLayer{{name, {}, kind, {}}, bare});
        layer->layer.channels.push_back(channel);
    }
    for (StoredLayer& stored : layers)
        std::stable_sort(stored.layer.channels.begin(), stored.layer.channels.end(), comes_before);
    std::stable_partition(layers.begin(), layers.end(),
                          [](const StoredLayer& stored) { return stored.layer.name.empty(); });
    return layers;
}

void read_header(const Imf::Header& header, LayeredImage& image) {
    const Imath::Box2i display = header.displayWindow();
    const Imath::Box2i data = header.dataWindow();
    const int x = display.min.x, y = display.min.y;
    image.width = display.max.x - x + 1;
    image.height = display.max.y - y + 1;
    image.window = {data.min.x - x, data.min.y - y, data.max.x - x + 1, data.max.y - y + 1};
    image.working_space = "lin_rec709";  // what the format means by no chromaticities
    if (Imf::hasChromaticities(header)) {
        const Imf::Chromaticities& c = Imf::chromaticities(header);
        const Chromaticities xy{c.red.x,  c.red.y,  c.green.x, c.green.y,
                                c.blue.x, c.blue.y, c.white.x, c.white.y};
        image.working_space = working_space_of(xy);
    }
    const Imf::Header plain;  // every header has these
    for (auto it = header.begin(); it != header.end(); ++it) {
        const std::string name = it.name();
        if (plain.find(name) != plain.end()) continue;
        if (const auto* i = dynamic_cast<const Imf::IntAttribute*>(&it.attribute()))
            image.metadata.emplace_back(name, i->value());
        else if (const auto* f = dynamic_cast<const Imf::FloatAttribute*>(&it.attribute()))
            image.metadata.emplace_back(name, f->value());
        else if (const auto* s = dynamic_cast<const Imf::StringAttribute*>(&it.attribute()))
            if (name != "type" && name != "name") image.metadata.emplace_back(name, s->value());
    }
}

/// Coordinates far outside what a frame can be would overflow the arithmetic of pixel addresses.
bool is_sane(const Imath::Box2i& box) {
    constexpr int kFar = 1 << 24;
    return box.min.x > -kFar && box.min.y > -kFar && box.max.x < kFar && box.max.y < kFar &&
           box.min.x <= box.max.x && box.min.y <= box.max.y;
}

void check_size(const Imf::Header& header, std::size_t channels, const ImageLimits& limits,
                const std::string& path) {
    const Imath::Box2i& box = header.dataWindow();
    if (!is_sane(box) || !is_sane(header.displayWindow()))
        fail_image(path, "its windows are empty or out of range");
    const std::int64_t pixels =
        std::int64_t(box.max.x - box.min.x + 1) * (box.max.y - box.min.y + 1);
    const auto count = static_cast<std::int64_t>(channels);
    if (pixels > limits.max_pixels ||
        pixels > limits.max_bytes / (4 * std::max<std::int64_t>(count, 1)))
        fail_image(path, "it has " + std::to_string(pixels) + " pixels of " +
                             std::to_string(channels) + " channels, more than the limit");
}

/// Reads strips and grows the layers with them: a file that lies about its size fails while small.
void read_pixels(Imf::InputPart& in, std::vector<StoredLayer>& layers) {
    const Imath::Box2i box = in.header().dataWindow();
    const auto width = static_cast<std::size_t>(box.max.x - box.min.x + 1);
    constexpr int kStrip = 128;
    for (int y = box.min.y; y <= box.max.y; y += kStrip) {
        const int last = std::min(y + kStrip - 1, box.max.y);
        const std::size_t done = static_cast<std::size_t>(y - box.min.y) * width;
        const std::size_t now = static_cast<std::size_t>(last - y + 1) * width;
        Imf::FrameBuffer frame;
        for (StoredLayer& stored : layers) {
            Layer& layer = stored.layer;
            const std::size_t count = layer.channels.size();
            layer.pixels.resize((done + now) * count);
            const std::int64_t origin =
                (std::int64_t(y) * static_cast<std::int64_t>(width) + box.min.x) *
                static_cast<std::int64_t>(count * sizeof(float));
            for (std::size_t c = 0; c < count; ++c) {
                const auto base =
                    reinterpret_cast<std::uintptr_t>(layer.pixels.data() + done * count + c) -
                    static_cast<std::uintptr_t>(origin);
                frame.insert(stored.channel_name(c),
                             Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base),
                                        count * sizeof(float), count * width * sizeof(float)));
            }
        }
        in.setFrameBuffer(frame);
        in.readPixels(y, last);
    }
}

/// The layers of each part, without pixels; all parts are checked.
std::vector<std::vector<StoredLayer>> plan(Imf::MultiPartInputFile& in, const ImageLimits& limits,
                                           const std::string& path) {
    std::vector<std::vector<StoredLayer>> parts;
    std::size_t channels = 0;
    for (int p = 0; p < in.parts(); ++p) {
        const Imf::Header& header = in.header(p);
        if (!in.partComplete(p)) fail_image(path, "the file is truncated");
        if (header.dataWindow() != in.header(0).dataWindow())
            fail_image(path, "its parts have different data windows, expected one for all");
        const std::string root = p > 0 && header.hasName() ? header.name() : "";
        parts.push_back(group(header.channels(), root, path));
        for (const StoredLayer& stored : parts.back()) channels += stored.layer.channels.size();
    }
    check_size(in.header(0), channels, limits, path);
    return parts;
}

LayeredImage read_checked(const std::string& path, const ImageLimits& limits) {
    if (Imf::isDeepOpenExrFile(path.c_str()))
        fail_image(path, "it is deep, expected a flat picture (tessera flatten makes one)");
    Imf::MultiPartInputFile in(path.c_str());
    std::vector<std::vector<StoredLayer>> parts = plan(in, limits, path);
    LayeredImage image;
    read_header(in.header(0), image);
    const std::size_t pixels = static_cast<std::size_t>(image.window.width()) *
                               static_cast<std::size_t>(image.window.height());
    for (std::size_t p = 0; p < parts.size(); ++p) {
        for (StoredLayer& stored : parts[p])
            stored.layer.pixels.reserve(pixels * stored.layer.channels.size());
        Imf::InputPart part(in, static_cast<int>(p));
        read_pixels(part, parts[p]);
        for (StoredLayer& stored : parts[p]) image.layers.push_back(std::move(stored.layer));
    }
    return image;
}

}  // namespace

LayeredImage read_exr(const std::string& path, const ImageLimits& limits) {
    if (sniff_image(path) != ImageFormat::exr) fail_image(path, "it is not an OpenEXR file");
    try {
        limit_exr_windows();
        return read_checked(path, limits);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, "image '" + path + "': cannot read: out of memory");
    } catch (const std::exception& error) {
        fail_image(path, error.what());
    }
}

}  // namespace tessera
