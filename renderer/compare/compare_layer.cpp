#include "renderer/compare/compare_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/compare/squared_error.h"
#include "renderer/compare/ssim.h"

namespace tessera {
namespace {

using Channels = std::vector<std::size_t>;

// The channels that are errors of light: R G B, or all but alpha.
Channels colours_of(const std::vector<std::string>& names) {
    Channels rgb;
    for (const char* name : {"R", "G", "B"}) {
        const auto at = std::find(names.begin(), names.end(), name);
        if (at != names.end()) rgb.push_back(static_cast<std::size_t>(at - names.begin()));
    }
    if (rgb.size() == 3) return rgb;
    Channels all;
    for (std::size_t c = 0; c < names.size(); ++c)
        if (names[c] != "A" || names.size() == 1) all.push_back(c);
    return all;
}

Channels all_of(const std::vector<std::string>& names) {
    Channels all(names.size());
    for (std::size_t c = 0; c < all.size(); ++c) all[c] = c;
    return all;
}

// Of pixels that are marked; the others are left out.
std::vector<float> gather(const PictureView& picture, const Channels& channels,
                          const std::vector<std::uint8_t>& marked) {
    std::vector<float> out;
    out.reserve(picture.pixels() * channels.size());
    for (std::size_t i = 0; i < marked.size(); ++i) {
        if (!marked[i]) continue;
        const std::span<const float> p = picture.pixel(i);
        for (const std::size_t c : channels) out.push_back(p[c]);
    }
    return out;
}

PictureView line_of(const std::vector<float>& values, std::size_t channels) {
    return {static_cast<int>(values.size() / channels), 1, static_cast<int>(channels), values};
}

// All pixels as linear RGB, black where one is not marked. One channel is grey.
std::vector<float> light_of(const PictureView& picture, const Channels& channels,
                            const std::vector<std::uint8_t>& marked, const ToLight& to_light) {
    std::vector<float> rgb(picture.pixels() * 3);
    for (std::size_t i = 0; i < marked.size(); ++i) {
        if (!marked[i]) continue;
        const std::span<const float> p = picture.pixel(i);
        for (std::size_t c = 0; c < 3; ++c) rgb[3 * i + c] = p[channels[c % channels.size()]];
    }
    if (to_light) to_light(rgb);
    return rgb;
}

class LayerComparison {
public:
    LayerComparison(const LayerPair& pair, const CompareOptions& options, Workers& workers)
        : pair_(pair),
          options_(options),
          workers_(workers),
          finite_(finite_in_both(pair.a, pair.reference)) {
        scores_.pixels = pair.a.pixels();
    }

    LayerScores run() {
        count();
        if (pair_.content == LayerContent::ids) return std::move(scores_);
        const auto bad = std::count(finite_.begin(), finite_.end(), std::uint8_t{0});
        set(Metric::non_finite, static_cast<double>(bad));
        if (static_cast<std::size_t>(bad) < finite_.size()) {
            measure_all();
            measure_colours();
        }
        return std::move(scores_);
    }

private:
    void set(Metric metric, double value) {
        scores_.values[static_cast<std::size_t>(metric)] = value;
    }

    void count() {
        const std::vector<std::uint8_t> unequal = differing(pair_.a, pair_.reference);
        set(Metric::different,
            static_cast<double>(std::count(unequal.begin(), unequal.end(), std::uint8_t{1})) /
                static_cast<double>(unequal.size()));
        const std::vector<ValueCounts> a = count_values(pair_.a), r = count_values(pair_.reference);
        for (std::size_t c = 0; c < a.size(); ++c)
            scores_.channels.push_back({pair_.channels[c], a[c], r[c], std::nullopt});
        if (!options_.maps) return;
        for (const std::uint8_t differs : unequal)
            scores_.relative.push_back(differs ? std::numeric_limits<float>::max() : 0.0f);
    }

    // What alpha counts for too.
    void measure_all() {
        const Channels all = all_of(pair_.channels);
        const std::vector<float> a = gather(pair_.a, all, finite_);
        const std::vector<float> r = gather(pair_.reference, all, finite_);
        double most = 0;
        std::vector<double> sums(all.size()), reference_sums(all.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            const auto p = static_cast<double>(a[i]), q = static_cast<double>(r[i]);
            most = std::max(most, std::fabs(p - q));
            sums[i % all.size()] += p, reference_sums[i % all.size()] += q;
        }
        set(Metric::max_abs, most);
        if (pair_.content != LayerContent::colour) return;
        double bias = 0;
        for (const std::size_t c : colours_of(pair_.channels))
            if (reference_sums[c] != 0 || sums[c] != 0)
                bias = std::max(bias, std::fabs(sums[c] / reference_sums[c] - 1));
        set(Metric::bias, bias);
        for (std::size_t c = 0; c < all.size(); ++c)
            if (reference_sums[c] != 0)
                scores_.channels[c].mean_ratio = sums[c] / reference_sums[c];
    }

    void measure_colours() {
        const bool colour = pair_.content == LayerContent::colour;
        const Channels channels = colour ? colours_of(pair_.channels) : all_of(pair_.channels);
        const std::vector<float> a = gather(pair_.a, channels, finite_);
        const std::vector<float> r = gather(pair_.reference, channels, finite_);
        const PictureView line = line_of(r, channels.size());
        const ReferenceScale scale = scale_of(line);
        const double epsilon = options_.epsilon.value_or(scale.epsilon);
        const SquaredErrors errors = squared_errors(line_of(a, channels.size()), line, epsilon);
        set(Metric::rmse, errors.rmse);
        if (options_.maps) keep_relative(errors.squares);
        if (!colour) return;
        scores_.epsilon = epsilon;
        set(Metric::relmse, errors.relmse);
        set(Metric::trimmed_relmse, errors.trimmed_relmse);
        const double peak = options_.encoded ? 1 : scale.peak;
        if (peak > 0) {
            scores_.psnr_peak = peak;
            set(Metric::psnr, psnr(errors.rmse, peak));
        }
        if (channels.size() == 1 || channels.size() == 3) measure_seen(channels);
    }

    void measure_seen(const Channels& channels) {
        const int w = pair_.a.width, h = pair_.a.height;
        const std::vector<float> a = light_of(pair_.a, channels, finite_, options_.a_to_light);
        const std::vector<float> r =
            light_of(pair_.reference, channels, finite_, options_.reference_to_light);
        const PictureView va{w, h, 3, a}, vr{w, h, 3, r};
        std::vector<float> flip =
            (options_.encoded ? ldr_flip : hdr_flip)(va, vr, options_.pixels_per_degree, workers_);
        double sum = 0, pixels = 0;
        for (std::size_t i = 0; i < flip.size(); ++i) {
            if (finite_[i])
                sum += static_cast<double>(flip[i]), ++pixels;
            else
                flip[i] = std::numeric_limits<float>::quiet_NaN();
        }
        set(Metric::flip, sum / pixels);
        if (options_.maps) scores_.flip = std::move(flip);
        measure_structure(a, r);
    }

    void measure_structure(const std::vector<float>& a, const std::vector<float>& r) {
        const double exposure = exposure_of(r);
        const ShownAs how = options_.encoded ? ShownAs::encoded : ShownAs::compressed;
        const std::vector<float> la = shown_luminance(a, how, exposure);
        const std::vector<float> lr = shown_luminance(r, how, exposure);
        const int w = pair_.a.width, h = pair_.a.height;
        if (const auto s = ssim({w, h, 1, la}, {w, h, 1, lr}, workers_)) set(Metric::ssim, *s);
    }

    void keep_relative(const std::vector<float>& squares) {
        std::size_t next = 0;
        for (std::size_t i = 0; i < finite_.size(); ++i)
            scores_.relative[i] =
                finite_[i] ? std::sqrt(squares[next++]) : std::numeric_limits<float>::quiet_NaN();
    }

    const LayerPair& pair_;
    const CompareOptions& options_;
    Workers& workers_;
    std::vector<std::uint8_t> finite_;
    LayerScores scores_;
};

}  // namespace

LayerScores compare_layer(const LayerPair& pair, const CompareOptions& options, Workers& workers) {
    return LayerComparison(pair, options, workers).run();
}

}  // namespace tessera
