#include <algorithm>
#include <cmath>
#include <memory>

#include "renderer/api/error.h"
#include "renderer/image/deep_reader.h"
#include "renderer/image/image_format.h"

namespace tessera {
namespace {

using Readers = std::vector<std::unique_ptr<DeepReader>>;

bool is_background(const DeepValue& v) { return v.rgba[3] == 0 && v.z >= kDeepBackground; }

bool inside(const PixelWindow& w, int x, int y) {
    return x >= w.x0 && x < w.x1 && y >= w.y0 && y < w.y1;
}

void check_same_frame(const DeepReader& first, const DeepReader& other) {
    const auto size = [](const DeepReader& r) {
        return std::to_string(r.width()) + "x" + std::to_string(r.height());
    };
    if (size(first) != size(other))
        fail_image(other.path(), "its frame is " + size(other) + ", that of '" + first.path() +
                                     "' is " + size(first));
    if (first.working_space() != other.working_space())
        fail_image(other.path(), "its primaries are not those of '" + first.path() + "'");
}

/// A line of every file, read in step.
class Merger {
public:
    explicit Merger(const Readers& readers)
        : readers_(readers), lines_(readers.size()), at_(readers.size()) {}

    void begin_line(int y) {
        y_ = y;
        for (std::size_t f = 0; f < readers_.size(); ++f) {
            at_[f] = 0;
            const PixelWindow& w = readers_[f]->window();
            if (y >= w.y0 && y < w.y1) readers_[f]->read(y, lines_[f]);
        }
    }

    /// R, G, B, A and Z of the next pixel of the line.
    void composite(int x, float* rgba, float& z) {
        gather(x);
        double left = 1;
        std::array<double, 4> sum{};
        z = kDeepBackground;
        for (std::size_t i = 0; i < pixel_.size(); ++i) {
            const DeepValue& v = pixel_[i];
            if (v.rgba[3] > 0) z = std::min(z, v.z);
            for (std::size_t c = 0; c < 4; ++c) sum[c] += left * static_cast<double>(v.rgba[c]);
            left *= 1 - std::min(static_cast<double>(v.rgba[3]), 1.0);
        }
        for (std::size_t c = 0; c < 4; ++c) rgba[c] = static_cast<float>(sum[c]);
    }

private:
    // All samples by depth, equal ones in the order of the files.
    void gather(int x) {
        pixel_.clear();
        bool behind = false;  // a file has said what the background is
        for (std::size_t f = 0; f < readers_.size(); ++f) {
            const PixelWindow& w = readers_[f]->window();
            if (!inside(w, x, y_)) continue;
            const DeepLine& line = lines_[f];
            for (std::uint32_t n = line.counts[static_cast<std::size_t>(x - w.x0)]; n > 0; --n) {
                const DeepValue& v = line.values[at_[f]++];
                if (!is_background(v) || !behind) pixel_.push_back(v);
            }
            behind = true;
        }
        std::stable_sort(pixel_.begin(), pixel_.end(),
                         [](const DeepValue& a, const DeepValue& b) { return a.z < b.z; });
        for (std::size_t i = 1; i < pixel_.size(); ++i) {
            if (pixel_[i].z >= pixel_[i - 1].z_back) continue;
            fail_image(readers_[0]->path(),
                       "pixel " + std::to_string(x) + "," + std::to_string(y_) +
                           ": samples overlap in depth (ZBack), which is not flattened here");
        }
    }

    const Readers& readers_;
    std::vector<DeepLine> lines_;
    std::vector<std::size_t> at_;  // how far each line is used up
    std::vector<DeepValue> pixel_;
    int y_ = 0;
};

}  // namespace

LayeredImage flatten_deep_exr(std::span<const std::string> paths) {
    Readers readers;
    for (const std::string& path : paths) {
        readers.push_back(std::make_unique<DeepReader>(path));
        check_same_frame(*readers[0], *readers.back());
    }
    LayeredImage image;
    image.width = readers[0]->width();
    image.height = readers[0]->height();
    image.working_space = readers[0]->working_space();
    PixelWindow& w = image.window = readers[0]->window();
    for (const auto& r : readers) {
        const PixelWindow& o = r->window();
        w = {std::min(w.x0, o.x0), std::min(w.y0, o.y0), std::max(w.x1, o.x1),
             std::max(w.y1, o.y1)};
    }
    const std::size_t pixels =
        static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height());
    Layer beauty{"", {"R", "G", "B", "A"}, LayerKind::color, std::vector<float>(pixels * 4)};
    Layer depth{"", {"Z"}, LayerKind::data, std::vector<float>(pixels)};
    Merger merger(readers);
    std::size_t i = 0;
    for (int y = w.y0; y < w.y1; ++y) {
        merger.begin_line(y);
        for (int x = w.x0; x < w.x1; ++x, ++i)
            merger.composite(x, &beauty.pixels[i * 4], depth.pixels[i]);
    }
    image.layers = {std::move(beauty), std::move(depth)};
    return image;
}

}  // namespace tessera
