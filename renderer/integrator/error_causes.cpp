#include "renderer/integrator/error_causes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "renderer/core/parallel.h"
#include "renderer/integrator/block.h"
#include "renderer/integrator/path_passes.h"

namespace tessera {
namespace {

constexpr std::size_t kMostPixels = 256, kFewestPixels = 8;
constexpr double kShareOfSamples = 0.03;
constexpr std::size_t kListed = 8;

struct Key {
    std::uint16_t pass;
    int seen, last;
    bool operator<(const Key& o) const {
        return std::tie(pass, seen, last) < std::tie(o.pass, o.seen, o.last);
    }
};

// By key: sums over samples of a part of the light, and of that times the whole.
struct Moments {
    double part = 0, product = 0;
};
using Parts = std::map<Key, Moments>;
// Of the variance, summed over pixels.
struct Shares {
    std::map<Key, double> of;
    int pixels = 0;
};

double grey(Color c) {
    return (static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z)) / 3;
}

LightPaths kinds_by_light(const Scene& scene) {
    Passes passes;
    for (const PathKind& k : kPathKinds) {
        Pass p;
        p.name = k.name;
        p.source = PassSource::light_paths;
        p.expression = k.expression;
        passes.push_back(std::move(p));
    }
    LightPaths paths(passes, scene.light_tags().tags(), {});
    paths.split_by_tag();
    return paths;
}

// Squared errors of all pixels.
std::vector<double> errors_of(const Film& film) {
    const ReplicateView v = film.replicates();
    std::vector<double> out(v.counts.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const PixelCounts& n = v.counts[i];
        if (!n.has_all()) continue;
        for (std::size_t c = 0; c < ReplicateView::kChannels; ++c) {
            const Sum* const sums = &v.sums[i * kReplicates * 3 + c];
            double mean = 0;
            for (std::size_t r = 0; r < kReplicates; ++r) mean += sums[3 * r].value() / n.total();
            for (std::size_t r = 0; r < kReplicates; ++r) {
                const double off = sums[3 * r].value() / n.samples[r] - mean;
                out[i] += n.samples[r] * off * off;
            }
        }
    }
    return out;
}

// How often each pixel is drawn: in proportion to its error, at even steps through their sum.
std::vector<std::pair<std::size_t, int>> draw(const std::vector<double>& errors,
                                              std::size_t count) {
    std::vector<std::pair<std::size_t, int>> out;
    const double total = std::accumulate(errors.begin(), errors.end(), 0.0);
    if (!(total > 0)) return out;
    const double step = total / static_cast<double>(count);
    double sum = 0, next = 0.5 * step;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        sum += errors[i];
        int times = 0;
        for (; next < sum; next += step) ++times;
        if (times > 0) out.emplace_back(i, times);
    }
    return out;
}

class Tracer {
public:
    Tracer(const Scene& scene, const Film& film, int first_sample)
        : scene_(scene),
          window_(film.window()),
          counts_(film.replicates().counts),
          first_sample_(static_cast<std::uint32_t>(first_sample)),
          paths_(kinds_by_light(scene)),
          filter_(scene.film().filter, scene.film().filter_width_px),
          kernel_(find_kernel(scene.settings().integrator, scene.kernel())) {}

    const LightPaths& paths() const noexcept { return paths_; }

    // Of up to sixteen pixels, each to the samples that the film has of it.
    void trace(std::span<const std::pair<std::size_t, int>> pixels, Shares& out) const {
        PassSamples unused;
        std::vector<PathPasses::Contribution> light;
        PathPasses passes(scene_, paths_, unused, light);
        BlockJob job;
        job.scene = &scene_;
        job.filter = &filter_;
        job.passes = &passes;
        std::uint32_t most = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const PixelWindow& w = window_;
            const int width = w.width(), pixel = static_cast<int>(pixels[i].first);
            aim_lane(job, static_cast<int>(i), w.x0 + pixel % width, w.y0 + pixel / width,
                     scene_.settings().seed);
            most = std::max(most, count(pixels[i].first));
        }
        BlockSamples samples;
        Counters counters;
        Parts parts[kLanes];
        Moments whole[kLanes];  // of the beauty itself
        for (std::uint32_t n = 0; n < most; ++n) {
            job.lanes = 0;
            for (std::size_t i = 0; i < pixels.size(); ++i)
                if (n < count(pixels[i].first)) job.lanes |= 1u << i;
            choose_sample(job, first_sample_ + n);
            light.clear();
            kernel_(job, samples, counters);
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const double l = (job.lanes >> i) & 1u ? grey(samples[i].radiance) : 0.0;
                whole[i].part += l, whole[i].product += l * l;
            }
            for (const PathPasses::Contribution& c : light) {
                const double part = grey(c.light);
                Moments& m = parts[c.lane][{c.pass, c.seen, c.last}];
                m.part += part, m.product += part * grey(samples[c.lane].radiance);
            }
        }
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const double mean = whole[i].part / count(pixels[i].first);
            const double variance = whole[i].product - mean * whole[i].part;
            if (!(variance > 0)) continue;
            out.pixels += pixels[i].second;
            for (const auto& [key, m] : parts[i])
                out.of[key] += pixels[i].second * (m.product - mean * m.part) / variance;
        }
    }

private:
    std::uint32_t count(std::size_t pixel) const { return counts_[pixel].total(); }

    const Scene& scene_;
    PixelWindow window_;
    std::span<const PixelCounts> counts_;
    std::uint32_t first_sample_;
    LightPaths paths_;
    FilterSampler filter_;
    BlockKernel kernel_;
};

std::string light_name(const LightTag& tag) {
    if (!tag.name.empty()) return tag.name;
    return tag.group > 0 ? tag.group_name : "";
}

}  // namespace

std::vector<ErrorCause> find_causes(const Scene& scene, const Film& film, int first_sample,
                                    Workers& workers) {
    if (scene.settings().integrator != Integrator::path || film.replicates().counts.empty())
        return {};
    const std::vector<double> errors = errors_of(film);
    const auto affordable =
        static_cast<std::size_t>(kShareOfSamples * static_cast<double>(errors.size()));
    const auto pixels = draw(errors, std::clamp(affordable, kFewestPixels, kMostPixels));
    const Tracer tracer(scene, film, first_sample);
    const std::size_t groups = (pixels.size() + kLanes - 1) / kLanes;
    std::vector<Shares> of_group(groups);
    workers.for_each(static_cast<int>(groups), [&](int g) {
        const std::size_t first = static_cast<std::size_t>(g) * kLanes;
        tracer.trace(
            std::span(pixels).subspan(first, std::min<std::size_t>(kLanes, pixels.size() - first)),
            of_group[static_cast<std::size_t>(g)]);
    });
    Shares all;
    for (const Shares& s : of_group) {
        all.pixels += s.pixels;
        for (const auto& [key, share] : s.of) all.of[key] += share;
    }
    std::vector<ErrorCause> out;
    for (const auto& [key, share] : all.of) {
        const int tags = tracer.paths().tags(), kind = key.pass / tags, tag = key.pass % tags;
        const auto material = [&](int m) { return m < 0 ? std::string() : scene.material_name(m); };
        const PathKind& k = kPathKinds[static_cast<std::size_t>(kind)];
        out.push_back({std::string(k.name),
                       light_name(scene.light_tags().tags()[static_cast<std::size_t>(tag)]),
                       material(key.seen), material(key.last), share / all.pixels,
                       std::string(k.remedy)});
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const ErrorCause& a, const ErrorCause& b) { return a.share > b.share; });
    if (out.size() > kListed) out.resize(kListed);
    return out;
}

}  // namespace tessera
