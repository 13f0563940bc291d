#include "renderer/film/deep_pixels.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tessera {
namespace {

constexpr std::uint32_t kBackground = UINT32_MAX;  // behind the key of any depth
constexpr int kStepBits = 12;                      // of a float's 23 that one step spans
constexpr int kMaxLevel = 20;                      // all depths in one step

// Floats as integers of the same order.
std::uint32_t ordered_bits(float z) noexcept {
    const auto bits = std::bit_cast<std::uint32_t>(z + 0.0f);  // -0 is 0
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

}  // namespace

std::size_t DeepPixels::depths(const Pixel& p) noexcept {
    return p.bins.size() - (!p.bins.empty() && p.bins.back().key == kBackground);
}

void DeepPixels::join(Bin& to, const Bin& added) noexcept {
    to.count += added.count;
    to.near = std::min(to.near, added.near);
    to.far = std::max(to.far, added.far);
    for (int c = 0; c < 3; ++c) to.rgb[c].add(added.rgb[c]);
}

void DeepPixels::coarsen(Pixel& p) {
    ++p.level;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < p.bins.size(); ++i) {
        Bin bin = p.bins[i];
        if (bin.key != kBackground) bin.key >>= 1;
        if (kept > 0 && p.bins[kept - 1].key == bin.key)
            join(p.bins[kept - 1], bin);
        else
            p.bins[kept++] = bin;
    }
    p.bins.resize(kept);
}

// Allocates, in the render loop: once for most pixels and pictures.
void DeepPixels::add(Pixel& p, const Bin& added) {
    const auto at = std::lower_bound(p.bins.begin(), p.bins.end(), added.key,
                                     [](const Bin& b, std::uint32_t key) { return b.key < key; });
    if (at != p.bins.end() && at->key == added.key)
        join(*at, added);
    else
        p.bins.insert(at, added);
    while (depths(p) > kMaxDepths) coarsen(p);
}

void DeepPixels::add(std::size_t pixel, float z, Color radiance) {
    Pixel& p = pixels_[pixel];
    z = std::min(z, std::nextafter(kDeepBackground, 0.0f));
    Bin bin{ordered_bits(z) >> (kStepBits + p.level), 1, z, z, {}};
    for (int c = 0; c < 3; ++c) bin.rgb[c].add(static_cast<double>(radiance[c]));
    add(p, bin);
}

void DeepPixels::add_background(std::size_t pixel, Color radiance) {
    if (max_component(radiance) <= 0.0f) return;
    Bin bin{kBackground, 1, kDeepBackground, kDeepBackground, {}};
    for (int c = 0; c < 3; ++c) bin.rgb[c].add(static_cast<double>(radiance[c]));
    add(pixels_[pixel], bin);
}

void DeepPixels::merge(std::size_t pixel, const DeepPixels& other, std::size_t from) {
    Pixel& to = pixels_[pixel];
    const Pixel& theirs = other.pixels_[from];
    while (to.level < theirs.level) coarsen(to);
    for (Bin bin : theirs.bins) {
        // The steps may double while bins are added.
        if (bin.key != kBackground) bin.key >>= to.level - theirs.level;
        add(to, bin);
    }
}

std::uint32_t DeepPixels::put(std::size_t pixel, std::uint32_t n,
                              std::vector<DeepSample>& out) const {
    const std::vector<Bin>& bins = pixels_[pixel].bins;
    const std::size_t depths = DeepPixels::depths(pixels_[pixel]), before = out.size();
    const double each = n > 0 ? 1.0 / n : 0.0;
    for (std::size_t i = 0; i < bins.size();) {
        Bin joined = bins[i++];
        const bool background = joined.key == kBackground;
        const float reach = joined.near + std::fabs(joined.near) * kTolerance;
        while (i < depths && bins[i].far <= reach) join(joined, bins[i++]);
        DeepSample s{joined.near, {}, background ? 0.0 : joined.count * each};
        for (std::size_t c = 0; c < 3; ++c)
            s.rgb[c] = static_cast<float>(joined.rgb[c].value() * each);
        out.push_back(s);
    }
    return static_cast<std::uint32_t>(out.size() - before);
}

DeepPixels::Counts DeepPixels::counts(std::size_t pixel) const noexcept {
    Counts n;
    for (const Bin& b : pixels_[pixel].bins)
        (b.key == kBackground ? n.background : n.hits) += b.count;
    return n;
}

std::size_t DeepPixels::crowded() const noexcept {
    return static_cast<std::size_t>(
        std::count_if(pixels_.begin(), pixels_.end(), [](const Pixel& p) { return p.level > 0; }));
}

DeepPixelsState DeepPixels::state() const {
    std::size_t bins = 0;
    for (const Pixel& p : pixels_) bins += p.bins.size();
    DeepPixelsState s;
    s.sizes.reserve(pixels_.size()), s.levels.reserve(pixels_.size());
    s.keys.reserve(bins), s.counts.reserve(bins);
    s.depths.reserve(2 * bins), s.sums.reserve(6 * bins);
    for (const Pixel& p : pixels_) {
        s.sizes.push_back(static_cast<std::uint8_t>(p.bins.size()));
        s.levels.push_back(p.level);
        for (const Bin& b : p.bins) {
            s.keys.push_back(b.key);
            s.counts.push_back(b.count);
            s.depths.insert(s.depths.end(), {b.near, b.far});
            for (const Sum& sum : b.rgb) s.sums.insert(s.sums.end(), {sum.high, sum.low});
        }
    }
    return s;
}

std::optional<DeepPixels> DeepPixels::from(const DeepPixelsState& s) {
    const std::size_t bins = s.keys.size();
    if (s.levels.size() != s.sizes.size() || s.counts.size() != bins ||
        s.depths.size() != 2 * bins || s.sums.size() != 6 * bins)
        return {};
    DeepPixels out(s.sizes.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < s.sizes.size(); ++i) {
        Pixel& p = out.pixels_[i];
        p.level = s.levels[i];
        if (p.level > kMaxLevel || s.sizes[i] > bins - at) return {};
        for (const std::size_t end = at + s.sizes[i]; at < end; ++at) {
            Bin bin{s.keys[at], s.counts[at], s.depths[2 * at], s.depths[2 * at + 1], {}};
            const int shift = kStepBits + p.level;
            const bool background = bin.key == kBackground;
            if (bin.count == 0 || !(bin.near <= bin.far) || !(bin.far <= kDeepBackground) ||
                background != (bin.near == kDeepBackground))
                return {};
            if (!background && (ordered_bits(bin.near) >> shift != bin.key ||
                                ordered_bits(bin.far) >> shift != bin.key))
                return {};
            if (!p.bins.empty() && bin.key <= p.bins.back().key) return {};
            for (std::size_t c = 0; c < 3; ++c) {
                bin.rgb[c] = {s.sums[6 * at + 2 * c], s.sums[6 * at + 2 * c + 1]};
                if (!std::isfinite(bin.rgb[c].value())) return {};
            }
            p.bins.push_back(bin);
        }
        if (depths(p) > kMaxDepths) return {};
    }
    if (at != bins) return {};
    return out;
}

std::size_t DeepPixels::bytes() const noexcept {
    std::size_t sum = pixels_.capacity() * sizeof(Pixel);
    for (const Pixel& p : pixels_) sum += p.bins.capacity() * sizeof(Bin);
    return sum;
}

void note_crowds(const DeepPixels& deep, std::vector<std::string>& notes) {
    if (deep.crowded() > 0)
        notes.push_back("deep: " + std::to_string(deep.crowded()) + " pixels see more than " +
                        std::to_string(DeepPixels::kMaxDepths) + " depths; theirs are coarser");
}

}  // namespace tessera
