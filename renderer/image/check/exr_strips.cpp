#include "renderer/image/check/exr_strips.h"

#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>

#include <algorithm>
#include <memory>
#include <new>

#include "renderer/image/exr_limits.h"

namespace tessera {
namespace {

constexpr std::int64_t kMaxChunk = std::int64_t(256) << 20;  // bytes decoded at once
constexpr std::int64_t kMaxValues = std::int64_t(1) << 31;   // in all

bool readable(const RawExr& file, std::size_t part) {
    const RawPart& p = file.parts[part];
    return !p.deep && p.data == file.parts[0].data &&
           std::all_of(p.channels.begin(), p.channels.end(),
                       [](const RawChannel& c) { return c.sampling_x == 1 && c.sampling_y == 1; });
}

std::int64_t lines_at_once(const RawPart& part) {
    if (!part.tiled) return part.chunk_lines();
    const auto tiles = part.attributes.find("tiles");
    const std::string& bytes = tiles->second.second;
    std::int64_t lines = 0;
    for (std::size_t i = 8; i-- > 4;) lines = lines << 8 | static_cast<unsigned char>(bytes[i]);
    return lines;
}

void read(Imf::InputPart& in, const RawPart& part, const ExrStripView& strip,
          std::vector<std::vector<float>>& planes) {
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < part.channels.size(); ++c) {
        planes[c].assign(strip.pixels(), 0.0f);
        const std::int64_t origin = (strip.y0 * strip.width + strip.x0) * std::int64_t{4};
        const auto base = reinterpret_cast<std::uintptr_t>(planes[c].data()) -
                          static_cast<std::uintptr_t>(origin);
        frame.insert(part.channels[c].name,
                     Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), sizeof(float),
                                static_cast<std::size_t>(strip.width) * sizeof(float)));
    }
    in.setFrameBuffer(frame);
    in.readPixels(static_cast<int>(strip.y0), static_cast<int>(strip.y0 + strip.height - 1));
}

}  // namespace

bool fits_to_read(const RawExr& file) {
    std::int64_t values = 0, side = 0;
    for (const RawPart& part : file.parts) {
        const auto channels =
            static_cast<std::int64_t>(std::max<std::size_t>(part.channels.size(), 1));
        const std::int64_t width = part.data.width();
        side = std::max({side, width, part.data.height()});
        if (width * std::max<std::int64_t>(lines_at_once(part), 32) > kMaxChunk / 4 / channels)
            return false;
        values += width * part.data.height() * channels;
        if (values > kMaxValues) return false;
    }
    return side <= 1 << 20;
}

std::string for_each_strip(const std::string& path, const RawExr& file,
                           const std::function<void(const ExrStripView&)>& look) {
    try {
        limit_exr_windows();
        Imf::MultiPartInputFile in(path.c_str(), 0);
        if (in.parts() != static_cast<int>(file.parts.size()))
            return "the library sees other parts";
        std::vector<std::unique_ptr<Imf::InputPart>> parts;
        ExrStripView strip;
        const RawBox& box = file.parts[0].data;
        std::int64_t lines = 1;
        for (std::size_t p = 0; p < file.parts.size(); ++p) {
            const bool use = readable(file, p);
            parts.push_back(use ? std::make_unique<Imf::InputPart>(in, static_cast<int>(p))
                                : nullptr);
            strip.planes.emplace_back(use ? file.parts[p].channels.size() : 0);
            if (use) lines = std::max(lines, lines_at_once(file.parts[p]));
        }
        strip.x0 = box.x0, strip.width = box.width();
        for (strip.y0 = box.y0; strip.y0 < box.y1; strip.y0 += strip.height) {
            strip.height = std::min(lines, box.y1 - strip.y0);
            for (std::size_t p = 0; p < parts.size(); ++p)
                if (parts[p]) read(*parts[p], file.parts[p], strip, strip.planes[p]);
            look(strip);
        }
    } catch (const std::bad_alloc&) {
        return "out of memory";
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

}  // namespace tessera
