#include "renderer/film/film.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/core/parallel.h"
#include "renderer/error/estimate.h"

namespace tessera {
namespace {

// How a pass's samples become its pixel.
enum class How { sums, nearest, counts, coverage };

How how(PassSource s) {
    switch (s) {
        case PassSource::z:
            return How::counts;  // the depth that decides which sample is nearest
        case PassSource::p:
        case PassSource::pref:
        case PassSource::uv:
        case PassSource::object_id:
        case PassSource::material_id:
            return How::nearest;
        case PassSource::crypto_object:
        case PassSource::crypto_material:
        case PassSource::crypto_asset:
            return How::coverage;
        case PassSource::sample_count:
        case PassSource::standard_error:
            return How::counts;
        default:
            return How::sums;
    }
}

bool wants_nearest(const Pass& p) {
    return p.source == PassSource::z || how(p.source) == How::nearest;
}

// Numbers that are summed up for a pixel.
std::size_t sums_of(const Pass& p) {
    return p.source == PassSource::shadow_matte ? 2 : p.channels.size();
}

void add(Sum* sums, Vec3f v) {
    sums[0].add(static_cast<double>(v.x));
    sums[1].add(static_cast<double>(v.y));
    sums[2].add(static_cast<double>(v.z));
}

double sum_of(Color c) {
    return static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z);
}

template <class Vector>
std::size_t capacity_bytes(const Vector& v) {
    return v.capacity() * sizeof(v[0]);
}

template <class Vector>
std::span<std::byte> bytes_of(Vector& v) {
    return std::as_writable_bytes(std::span(v));
}

void make_room(Layer& layer, const PixelWindow& part) {
    layer.pixels.resize(static_cast<std::size_t>(part.width()) *
                        static_cast<std::size_t>(part.height()) * layer.channels.size());
}

}  // namespace

void PassSamples::clear() {
    for (FirstHit& f : first) f = FirstHit{};
    std::fill(light.begin(), light.end(), Color(0.0f));
    std::fill(event_albedos.begin(), event_albedos.end(), Color(0.0f));
}

Film::Film(const PixelWindow& window, Passes passes, FilmExtras extras)
    : window_(window),
      passes_(std::move(passes)),
      beauty_(window, extras.replicates ? std::optional(extras.seed) : std::nullopt),
      planes_(passes_.size()) {
    const std::size_t n =
        static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    if (extras.deep) deep_.emplace(n);
    if (std::any_of(passes_.begin(), passes_.end(), wants_nearest)) nearest_.resize(n);
    for (std::size_t p = 0; p < passes_.size(); ++p) {
        const Pass& pass = passes_[p];
        planes_[p].source = pass.source;
        planes_[p].events = pass.events;
        planes_[p].width = static_cast<std::uint32_t>(sums_of(pass));
        if (how(pass.source) == How::sums) planes_[p].sums.resize(n * planes_[p].width);
        if (how(pass.source) == How::nearest) planes_[p].nearest.resize(n * planes_[p].width);
        if (how(pass.source) == How::coverage) planes_[p].coverage.emplace(n);
        light_passes_ += pass.source == PassSource::light_paths;
        event_albedos_ |= pass.source == PassSource::event_albedo;
    }
}

PassSamples Film::pass_samples() const {
    PassSamples s;
    s.light.resize(static_cast<std::size_t>(light_passes_) * kLanes);
    if (event_albedos_) s.event_albedos.resize(std::size_t{kLobeEvents} * kLanes);
    return s;
}

void Film::add(int x, int y, std::uint32_t index, const PathSample& s, const PassSamples* passes,
               int lane) noexcept {
    const std::size_t i = pixel(x, y);
    beauty_.add(i, index, s);
    if (!passes) return;
    add_passes(i, index, s, *passes, lane);
    if (!deep_) return;
    if (s.alpha > 0.0f)
        deep_->add(i, passes->first[lane].z, s.radiance);
    else
        deep_->add_background(i, s.radiance);
}

void Film::add_passes(std::size_t i, std::uint32_t index, const PathSample& s,
                      const PassSamples& passes, int lane) noexcept {
    const FirstHit& f = passes.first[lane];
    bool nearer = false;
    if (!nearest_.empty() && f.hit) {
        Nearest& nearest = nearest_[i];
        nearer = f.z < nearest.z || (f.z == nearest.z && index < nearest.sample);
        if (nearer) nearest = {f.z, index};
    }
    const Color* light = passes.light.data() + lane;
    for (Plane& plane : planes_) {
        Sum* const sums = plane.sums.data() + i * plane.width;
        float* const value = plane.nearest.data() + i * plane.width;
        const auto count = [&](std::uint32_t number) {
            if (number > 0) plane.coverage->add(i, number - 1);
        };
        const auto put = [&](Vec3f v) {
            if (nearer) value[0] = v.x, value[1] = v.y, value[2] = v.z;
        };
        switch (plane.source) {
            case PassSource::z:
            case PassSource::sample_count:
            case PassSource::standard_error:
                break;
            case PassSource::depth:
                if (f.hit) sums->add(static_cast<double>(f.z));
                break;
            case PassSource::p:
                put(f.p);
                break;
            case PassSource::pref:
                put(f.pref);
                break;
            case PassSource::uv:
                put({f.uv.x, f.uv.y, f.has_uv ? 1.0f : 0.0f});
                break;
            case PassSource::n:
                if (f.hit) tessera::add(sums, f.n);
                break;
            case PassSource::ng:
                if (f.hit) tessera::add(sums, f.ng);
                break;
            case PassSource::facing:
                if (f.hit) sums->add(static_cast<double>(f.facing));
                break;
            case PassSource::albedo:
                tessera::add(sums, f.albedo);
                break;
            case PassSource::event_albedo: {
                Color sum(0.0f);
                for (std::uint32_t m = plane.events; m != 0; m &= m - 1) {
                    const int at = std::countr_zero(m) * kLanes + lane;
                    sum += passes.event_albedos[static_cast<std::size_t>(at)];
                }
                tessera::add(sums, sum);
                break;
            }
            case PassSource::light_paths:
                tessera::add(sums, *light);
                light += kLanes;
                break;
            case PassSource::shadow:
                tessera::add(sums, f.shadowed);
                break;
            case PassSource::shadow_matte:
                sums[0].add(sum_of(f.shadowed));
                sums[1].add(sum_of(f.unshadowed));
                break;
            case PassSource::ao:
                if (f.hit) sums->add(static_cast<double>(f.ao));
                break;
            case PassSource::object_id:
                if (nearer) *value = static_cast<float>(f.object);
                break;
            case PassSource::material_id:
                if (nearer) *value = static_cast<float>(f.material);
                break;
            case PassSource::crypto_object:
                count(f.object);
                break;
            case PassSource::crypto_material:
                count(f.material);
                break;
            case PassSource::crypto_asset:
                count(f.asset);
                break;
            case PassSource::seconds:
                sums->add(static_cast<double>(passes.seconds[lane]));
                break;
            case PassSource::variance: {
                const Vec3d v(s.radiance);
                sums[0].add(v.x * v.x), sums[1].add(v.y * v.y), sums[2].add(v.z * v.z);
                break;
            }
        }
    }
}

void Film::merge(const Film& other) {
    const PixelWindow& w = other.window_;
    beauty_.merge_probes(other.beauty_);
    for (int y = w.y0; y < w.y1; ++y) {
        for (int x = w.x0; x < w.x1; ++x) {
            const std::size_t to = pixel(x, y), from = other.pixel(x, y);
            beauty_.merge(to, other.beauty_, from);
            if (deep_) deep_->merge(to, *other.deep_, from);
            bool nearer = false;
            if (!nearest_.empty()) {
                Nearest& a = nearest_[to];
                const Nearest& b = other.nearest_[from];
                nearer = b.z < a.z || (b.z == a.z && b.sample < a.sample);
                if (nearer) a = b;
            }
            for (std::size_t p = 0; p < planes_.size(); ++p) {
                Plane& plane = planes_[p];
                const Plane& add = other.planes_[p];
                const std::size_t sums = plane.sums.empty() ? 0 : sums_of(passes_[p]);
                for (std::size_t c = 0; c < sums; ++c)
                    plane.sums[to * sums + c].add(add.sums[from * sums + c]);
                if (plane.coverage) plane.coverage->merge(to, *add.coverage, from);
                const std::size_t values = plane.nearest.empty() ? 0 : passes_[p].channels.size();
                for (std::size_t c = 0; nearer && c < values; ++c)
                    plane.nearest[to * values + c] = add.nearest[from * values + c];
            }
        }
    }
}

std::vector<Layer> Film::layers(Workers& workers) const {
    std::vector<Layer> out = outline();
    const bool wanted = std::any_of(passes_.begin(), passes_.end(), [](const Pass& p) {
        return p.source == PassSource::standard_error;
    });
    const double calibration = wanted ? estimate_error(replicates(), workers).calibration : 1.0;
    workers.for_each(static_cast<int>(out.size()), [&](int i) { make_room(out[i], window_); });
    workers.for_each(window_.height(),
                     [&](int row) { put_row(window_, window_.y0 + row, calibration, out); });
    return out;
}

std::vector<Layer> Film::layers(const PixelWindow& part) const {
    std::vector<Layer> out = outline();
    for (Layer& layer : out) make_room(layer, part);
    for (int y = part.y0; y < part.y1; ++y) put_row(part, y, 1.0, out);
    return out;
}

// The layers without their pixels.
std::vector<Layer> Film::outline() const {
    std::vector<Layer> out{{"", {"R", "G", "B", "A"}, LayerKind::color, {}}};
    for (std::size_t p = 0; p < passes_.size(); ++p) {
        if (!planes_[p].coverage)
            out.push_back({passes_[p].name, passes_[p].channels, passes_[p].kind, {}});
    }
    return out;
}

void Film::put_row(const PixelWindow& part, int y, double calibration,
                   std::vector<Layer>& layers) const {
    const auto width = static_cast<std::size_t>(part.width());
    const std::size_t from = pixel(part.x0, y), to = static_cast<std::size_t>(y - part.y0) * width;
    for (std::size_t x = 0; x < width; ++x) {
        const PixelCounts& n = counts()[from + x];
        const double w = n.total() > 0 ? 1.0 / n.total() : 0.0;
        float* const out = &layers[0].pixels[(to + x) * 4];
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = static_cast<float>(beauty_.sum(from + x, c).value() * w);
        out[3] = static_cast<float>(n.hits * w);
    }
    auto layer = layers.begin() + 1;
    for (std::size_t p = 0; p < passes_.size(); ++p) {
        if (planes_[p].coverage) continue;
        float* const out = &layer->pixels[to * layer->channels.size()];
        for (std::size_t x = 0; x < width; ++x)
            put_pixel(passes_[p], planes_[p], from + x, out + x * layer->channels.size());
        for (std::size_t x = 0; passes_[p].source == PassSource::standard_error && x < width; ++x)
            beauty_.standard_error(from + x, calibration, out + 3 * x);
        ++layer;
    }
}

bool Film::take_deep(const DeepPixelsState& state) {
    std::optional<DeepPixels> read = DeepPixels::from(state);
    bool fits = read && read->pixels() == counts().size();
    for (std::size_t i = 0; fits && i < counts().size(); ++i) {
        const DeepPixels::Counts n = read->counts(i);
        fits = n.hits == counts()[i].hits && n.hits + n.background <= counts()[i].total();
    }
    if (fits) deep_ = std::move(read);
    return fits;
}

DeepImage Film::deep_image() const {
    DeepImage image;
    image.window = window_;
    for (std::size_t i = 0; deep_ && i < counts().size(); ++i)
        image.counts.push_back(deep_->put(i, counts()[i].total(), image.samples));
    return image;
}

std::vector<std::uint32_t> Film::sample_counts() const {
    std::vector<std::uint32_t> out;
    out.reserve(counts().size());
    for (const PixelCounts& n : counts()) out.push_back(n.total());
    return out;
}

void Film::put_pixel(const Pass& pass, const Plane& plane, std::size_t i, float* out) const {
    const std::size_t channels = pass.channels.size();
    const std::uint32_t samples = counts()[i].total(), hits = counts()[i].hits;
    const double each = samples > 0 ? 1.0 / samples : 0.0;
    const Sum* const sums = plane.sums.data() + i * sums_of(pass);
    switch (pass.source) {
        case PassSource::z:
            *out = std::min(nearest_[i].z, kEmptyDepth);
            return;
        case PassSource::sample_count:
            *out = static_cast<float>(samples);
            return;
        case PassSource::standard_error:
            return;  // put_row() knows its calibration
        case PassSource::seconds:
            *out = static_cast<float>(sums->value());
            return;
        case PassSource::shadow_matte: {
            const double all = sums[1].value();
            *out = all > 0 ? static_cast<float>(sums[0].value() / all) : 0.0f;
            return;
        }
        case PassSource::variance:
            for (std::size_t c = 0; c < channels; ++c) {
                const double sum = beauty_.sum(i, c).value(), count = samples;
                const double v =
                    count > 1 ? (sums[c].value() - sum * sum * each) / (count * (count - 1)) : 0.0;
                out[c] = static_cast<float>(std::max(v, 0.0));
            }
            return;
        default:
            break;
    }
    if (!plane.nearest.empty()) {
        std::copy_n(&plane.nearest[i * channels], channels, out);
        return;
    }
    // Colour is premultiplied by coverage as beauty is; data is the mean over what was hit.
    const double hit = hits > 0 ? 1.0 / hits : 0.0;
    const double w = pass.kind == LayerKind::color ? each : hit;
    const bool albedo =
        pass.source == PassSource::albedo || pass.source == PassSource::event_albedo;
    for (std::size_t c = 0; c < channels; ++c) {
        out[c] = static_cast<float>(sums[c].value() * w);
        // A colour of at most 1; single samples of it may be more.
        if (albedo) out[c] = std::min(out[c], 1.0f);
    }
}

std::size_t Film::bytes() const noexcept {
    std::size_t sum = beauty_.bytes() + capacity_bytes(nearest_);
    if (deep_) sum += deep_->bytes();
    for (const Plane& p : planes_) {
        sum += capacity_bytes(p.sums) + capacity_bytes(p.nearest);
        if (p.coverage) sum += p.coverage->bytes();
    }
    return sum;
}

std::uint64_t Film::expected_bytes(const PixelWindow& window, const Passes& passes,
                                   FilmExtras extras) {
    const std::uint64_t n =
        static_cast<std::uint64_t>(window.width()) * static_cast<std::uint64_t>(window.height());
    std::uint64_t sum = extras.deep ? n * DeepPixels::kBytesOfOneDepth : 0;
    for (const ArraySize& a : array_sizes(window, passes, extras)) sum += a.bytes;
    for (const Pass& p : passes)
        if (how(p.source) == How::coverage) sum += n * IdCoverage::kBytesOfOneName;
    return sum;
}

std::vector<Film::Array> Film::arrays() {
    std::vector<Array> out;
    const std::vector<ArraySize> sizes =
        array_sizes(window_, passes_, {deep_.has_value(), beauty_.has_replicates(), 0});
    const auto add = [&](auto& v) {
        if (!v.empty()) out.push_back({sizes[out.size()].name, bytes_of(v)});
    };
    add(beauty_.sums()), add(beauty_.counts());
    add(nearest_);
    for (Plane& plane : planes_) add(plane.sums), add(plane.nearest);
    if (Probes* p = probes()) add(p->sums()), add(p->counts());
    return out;
}

std::vector<Film::ArraySize> Film::array_sizes(const PixelWindow& window, const Passes& passes,
                                               FilmExtras extras) {
    const std::uint64_t n =
        static_cast<std::uint64_t>(window.width()) * static_cast<std::uint64_t>(window.height());
    const std::uint64_t sums = Beauty::sums_of_pixel(extras.replicates);
    const std::uint64_t cells = extras.replicates ? ProbeGrid(window, 0).cells() : 0;
    std::vector<ArraySize> out{{"beauty", n * sums * sizeof(Sum)},
                               {"counts", n * sizeof(PixelCounts)}};
    if (std::any_of(passes.begin(), passes.end(), wants_nearest))
        out.push_back({"nearest", n * sizeof(Nearest)});
    for (const Pass& p : passes) {
        if (how(p.source) == How::sums)
            out.push_back({p.name + ".sums", n * sums_of(p) * sizeof(Sum)});
        if (how(p.source) == How::nearest)
            out.push_back({p.name + ".nearest", n * p.channels.size() * sizeof(float)});
    }
    if (extras.replicates) {
        out.push_back({"probes.sums", 3 * cells * sizeof(Sum)});
        out.push_back({"probes.counts", cells * sizeof(std::uint32_t)});
    }
    return out;
}

}  // namespace tessera
