#include "renderer/cli/compare_sides.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "renderer/api/error.h"

namespace tessera {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ExitCode::scene, message); }

PixelWindow common(const PixelWindow& a, const PixelWindow& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

std::string to_string(const PixelWindow& w) {
    return fmt::format("{},{},{},{}", w.x0, w.y0, w.x1, w.y1);
}

/// Channels of a layer in an order of choice, over a window; copied only if it must be.
class LayerView {
public:
    LayerView(const Layer& layer, const PixelWindow& has, const PixelWindow& wanted,
              const std::vector<std::string>& channels) {
        view_ = {wanted.width(), wanted.height(), static_cast<int>(channels.size()), layer.pixels};
        if (has == wanted && channels == layer.channels) return;
        const std::size_t count = layer.channels.size();
        std::vector<std::size_t> from;
        for (const std::string& c : channels)
            from.push_back(static_cast<std::size_t>(
                std::find(layer.channels.begin(), layer.channels.end(), c) -
                layer.channels.begin()));
        copy_.reserve(view_.pixels() * channels.size());
        for (int y = wanted.y0; y < wanted.y1; ++y) {
            for (int x = wanted.x0; x < wanted.x1; ++x) {
                const std::size_t at =
                    static_cast<std::size_t>(y - has.y0) * static_cast<std::size_t>(has.width()) +
                    static_cast<std::size_t>(x - has.x0);
                for (const std::size_t c : from) copy_.push_back(layer.pixels[at * count + c]);
            }
        }
        view_.values = copy_;
    }
    LayerView(const LayerView&) = delete;
    LayerView& operator=(const LayerView&) = delete;

    const PictureView& view() const { return view_; }

private:
    PictureView view_;
    std::vector<float> copy_;
};

/// Scores of one file by layer.
struct FileScores {
    std::vector<std::string> titles;
    std::vector<LayerScores> layers;
};

void add(const ValueCounts& from, ValueCounts& to) {
    to.nan += from.nan, to.infinite += from.infinite, to.negative += from.negative;
}

SideScores over_seeds(const std::vector<FileScores>& files, std::size_t layer, bool independent) {
    SideScores side;
    for (std::size_t m = 0; m < kMetrics; ++m) {
        std::vector<double> values;
        for (const FileScores& f : files)
            if (const auto& v = f.layers[layer].values[m]) values.push_back(*v);
        if (values.size() != files.size()) continue;  // not measured in one is not measured
        SeedInterval interval = seed_interval(values);
        if (!independent) interval = {interval.mean, interval.mean, interval.mean, 1};
        side.values[m] = interval;
    }
    side.channels = files[0].layers[layer].channels;
    for (std::size_t c = 0; c < side.channels.size(); ++c) {
        ChannelScores& sum = side.channels[c];
        for (std::size_t f = 1; f < files.size(); ++f) {
            const ChannelScores& channel = files[f].layers[layer].channels[c];
            add(channel.a, sum.a);
            if (sum.mean_ratio && channel.mean_ratio) *sum.mean_ratio += *channel.mean_ratio;
        }
        if (sum.mean_ratio) *sum.mean_ratio /= static_cast<double>(files.size());
    }
    return side;
}

class SidesComparison {
public:
    explicit SidesComparison(const CompareRequest& request)
        : request_(request),
          workers_(request.threads),
          reference_(read_compared(request.reference)) {
        out_.sides = request.sides;
        out_.reference = request.reference;
        out_.width = reference_.image.width, out_.height = reference_.image.height;
        out_.encoded = reference_.encoded;
        out_.working_space = reference_.image.working_space;
    }

    Comparison run() {
        out_.seeds = true;
        for (const std::vector<std::string>& files : request_.sides) compare_side(files);
        return std::move(out_);
    }

private:
    void note(const std::string& text) {
        if (std::find(out_.notes.begin(), out_.notes.end(), text) == out_.notes.end())
            out_.notes.push_back(text);
    }

    void compare_side(const std::vector<std::string>& files) {
        std::vector<FileScores> scores;
        std::set<std::string> seeds;
        bool independent = true;
        for (const std::string& path : files) {
            const ComparedPicture picture = read_compared(path);
            check_frame(picture);
            remark(picture);
            if (!picture.seed.empty() && !seeds.insert(picture.seed).second) {
                independent = false;
                note(
                    fmt::format("{}: seed {} is that of another file of its side; without "
                                "independent noise there are no intervals",
                                path, picture.seed));
            }
            scores.push_back(compare_file(picture, scores.empty()));
            if (scores.back().titles != scores.front().titles)
                refuse(path + ": its layers are not those of " + files[0]);
        }
        out_.seeds = out_.seeds && independent && files.size() > 1;
        collect(scores, independent);
    }

    void collect(const std::vector<FileScores>& scores, bool independent) {
        for (std::size_t i = 0; i < scores[0].titles.size(); ++i) {
            const std::string& title = scores[0].titles[i];
            const LayerScores& first = scores[0].layers[i];
            auto layer = std::find_if(out_.layers.begin(), out_.layers.end(),
                                      [&](const ComparedLayer& l) { return l.title == title; });
            if (layer == out_.layers.end())
                layer = out_.layers.insert(layer, {title,
                                                   content_of(*reference_.find(title)),
                                                   first.pixels,
                                                   first.epsilon,
                                                   first.psnr_peak,
                                                   {}});
            layer->sides.push_back(over_seeds(scores, i, independent));
        }
    }

    void check_frame(const ComparedPicture& p) const {
        if (p.image.width != out_.width || p.image.height != out_.height)
            refuse(fmt::format("{}: is {} x {} pixels, {} is {} x {}", p.path, p.image.width,
                               p.image.height, reference_.path, out_.width, out_.height));
        if (p.encoded != reference_.encoded)
            refuse(fmt::format("{}: has {}, {} has {}; compare files of one kind", p.path,
                               kind_of(p), reference_.path, kind_of(reference_)));
        const PixelWindow w = common(p.image.window, reference_.image.window);
        if (w.x1 <= w.x0 || w.y1 <= w.y0)
            refuse(fmt::format("{}: its pixels {} have none in common with {} of {}", p.path,
                               to_string(p.image.window), to_string(reference_.image.window),
                               reference_.path));
    }

    static const char* kind_of(const ComparedPicture& p) {
        return p.encoded ? "integers for a display" : "floats of light";
    }

    void remark(const ComparedPicture& p) {
        const PixelWindow &w = p.image.window, &r = reference_.image.window;
        if (!(w == r))
            note(fmt::format("{} has pixels {}, {} has {}: only {} is compared", p.path,
                             to_string(w), reference_.path, to_string(r), to_string(common(w, r))));
        const std::string &space = p.image.working_space, &other = reference_.image.working_space;
        if (space != other)
            note(
                fmt::format("{} has the primaries of {}, {} those of {}: numbers are compared as "
                            "they are, FLIP and SSIM as they look",
                            p.path, space.empty() ? "an unknown space" : space, reference_.path,
                            other.empty() ? "an unknown space" : other));
        // The seed is one of the settings: with another one another hash says nothing.
        const std::string &a = p.scene_hash, &b = reference_.scene_hash;
        if (!a.empty() && !b.empty() && a != b && p.seed == reference_.seed)
            note(
                fmt::format("scene hashes differ: {} in {}, {} in {}: another scene, or other "
                            "settings",
                            a, p.path, b, reference_.path));
    }

    bool wanted(const std::string& title) const {
        return request_.layers.empty() || std::find(request_.layers.begin(), request_.layers.end(),
                                                    title) != request_.layers.end();
    }

    void add_lone(const std::string& name, const std::string& file) {
        const auto same = [&](const LonePart& l) { return l.name == name && l.file == file; };
        if (std::none_of(out_.lone.begin(), out_.lone.end(), same))
            out_.lone.push_back({name, file});
    }

    // Channels that both have, in the reference's order.
    std::vector<std::string> shared_channels(const Layer& a, const Layer& r,
                                             const std::string& path) {
        std::vector<std::string> shared;
        const auto has = [](const Layer& layer, const std::string& channel) {
            return std::find(layer.channels.begin(), layer.channels.end(), channel) !=
                   layer.channels.end();
        };
        for (const std::string& c : r.channels) {
            if (has(a, c))
                shared.push_back(c);
            else
                add_lone(title_of(r) + "." + c, reference_.path);
        }
        for (const std::string& c : a.channels)
            if (!has(r, c)) add_lone(title_of(r) + "." + c, path);
        return shared;
    }

    FileScores compare_file(const ComparedPicture& picture, bool first) {
        for (const std::string& name : request_.layers) {
            need(name, picture, reference_);
            need(name, reference_, picture);
        }
        FileScores out;
        for (const Layer& r : reference_.image.layers) {
            const std::string title = title_of(r);
            const Layer* const a = counterpart(r, reference_, picture);
            if (!wanted(title) && !(a && wanted(title_of(*a)))) continue;
            if (!a) {
                add_lone(title, reference_.path);
                continue;
            }
            const std::vector<std::string> channels = shared_channels(*a, r, picture.path);
            if (channels.empty()) continue;
            out.titles.push_back(title);
            out.layers.push_back(compare(picture, *a, r, channels, first));
        }
        for (const Layer& a : picture.image.layers)
            if (wanted(title_of(a)) && !counterpart(a, picture, reference_))
                add_lone(title_of(a), picture.path);
        if (out.titles.empty())
            refuse(picture.path + ": has no layer in common with " + reference_.path);
        return out;
    }

    static void need(const std::string& name, const ComparedPicture& picture,
                     const ComparedPicture& other) {
        const Layer* const elsewhere = other.find(name);
        if (!picture.find(name) && !(elsewhere && counterpart(*elsewhere, other, picture)))
            refuse(picture.path + ": has no layer '" + name + "'" + listed(picture));
    }

    static std::string listed(const ComparedPicture& picture) {
        std::string names;
        for (const Layer& l : picture.image.layers)
            names += (names.empty() ? "" : ", ") + title_of(l);
        return " (it has " + names + ")";
    }

    LayerScores compare(const ComparedPicture& picture, const Layer& a, const Layer& r,
                        const std::vector<std::string>& channels, bool first) {
        const PixelWindow window = common(picture.image.window, reference_.image.window);
        const LayerView va(a, picture.image.window, window, channels);
        const LayerView vr(r, reference_.image.window, window, channels);
        CompareOptions options;
        options.epsilon = request_.epsilon;
        options.pixels_per_degree = request_.pixels_per_degree;
        options.encoded = reference_.encoded;
        options.a_to_light = to_light(picture);
        options.reference_to_light = to_light(reference_);
        const std::string title = title_of(r);
        if (request_.maps && out_.maps.layer.empty()) out_.maps.layer = title;
        options.maps = request_.maps && first && out_.maps.layer == title;
        LayerScores scores =
            compare_layer({channels, content_of(r), va.view(), vr.view()}, options, workers_);
        if (options.maps) {
            out_.maps.width = window.width(), out_.maps.height = window.height();
            out_.maps.relative.push_back(std::move(scores.relative));
            out_.maps.flip.push_back(std::move(scores.flip));
        }
        return scores;
    }

    const CompareRequest& request_;
    Workers workers_;
    ComparedPicture reference_;
    Comparison out_;
};

}  // namespace

Comparison compare_pictures(const CompareRequest& request) {
    return SidesComparison(request).run();
}

}  // namespace tessera
