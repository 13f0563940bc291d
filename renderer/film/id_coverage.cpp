#include "renderer/film/id_coverage.h"

#include <algorithm>
#include <array>
#include <new>

namespace tessera {
namespace {

bool by_key(const KeyCount& a, const KeyCount& b) { return a.key < b.key; }

}  // namespace

void IdCoverage::add(std::size_t pixel, std::uint32_t key, std::uint32_t count) noexcept {
    if (count == 0) return;
    Pixel& p = pixels_[pixel];
    if (p.first.count == 0) {
        p.first = {key, count};
    } else if (p.first.key == key) {
        p.first.count += count;
    } else {
        try {
            add_more(p, {key, count});
        } catch (const std::bad_alloc&) {
            if (p.more) p.more->dropped += count;
        }
    }
}

// Allocates, in the render loop: a few times per pixel and picture, at the edges of things.
void IdCoverage::add_more(Pixel& p, KeyCount added) {
    if (!p.more) p.more = std::make_unique<More>();
    std::vector<KeyCount>& counts = p.more->counts;
    const auto known = std::find_if(counts.begin(), counts.end(),
                                    [&](const KeyCount& c) { return c.key == added.key; });
    if (known != counts.end()) {
        known->count += added.count;
        return;
    }
    if (counts.size() + 1 < kMaxKeys) {
        counts.push_back(added);
        return;
    }
    KeyCount* last = &*std::max_element(counts.begin(), counts.end(), by_key);
    if (by_key(*last, p.first)) last = &p.first;
    if (by_key(added, *last)) std::swap(added, *last);
    p.more->dropped += added.count;
}

void IdCoverage::merge(std::size_t pixel, const IdCoverage& other, std::size_t from) noexcept {
    std::array<KeyCount, kMaxKeys> theirs;
    const std::size_t n = other.counts(from, theirs);
    for (std::size_t i = 0; i < n; ++i) add(pixel, theirs[i].key, theirs[i].count);
    // Who dropped has a full list, so there is one here now.
    if (const std::uint32_t dropped = other.dropped(from); dropped > 0 && pixels_[pixel].more)
        pixels_[pixel].more->dropped += dropped;
}

std::size_t IdCoverage::counts(std::size_t pixel,
                               std::span<KeyCount, kMaxKeys> out) const noexcept {
    const Pixel& p = pixels_[pixel];
    if (p.first.count == 0) return 0;
    out[0] = p.first;
    if (!p.more) return 1;
    std::copy(p.more->counts.begin(), p.more->counts.end(), out.begin() + 1);
    return p.more->counts.size() + 1;
}

IdCoverageState IdCoverage::state() const {
    IdCoverageState s;
    s.sizes.reserve(pixels_.size());
    std::array<KeyCount, kMaxKeys> sorted;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        const std::size_t n = counts(i, sorted);
        std::sort(sorted.begin(), sorted.begin() + n, by_key);
        s.sizes.push_back(static_cast<std::uint8_t>(n));
        for (std::size_t k = 0; k < n; ++k) {
            s.keys.push_back(sorted[k].key);
            s.counts.push_back(sorted[k].count);
        }
        if (dropped(i) == 0) continue;
        s.dropped_at.push_back(static_cast<std::uint32_t>(i));
        s.dropped.push_back(dropped(i));
    }
    return s;
}

std::optional<IdCoverage> IdCoverage::from(const IdCoverageState& s, std::uint32_t key_limit) {
    if (s.keys.size() != s.counts.size() || s.dropped_at.size() != s.dropped.size()) return {};
    IdCoverage out(s.sizes.size());
    std::size_t at = 0;
    for (std::size_t i = 0; i < s.sizes.size(); ++i) {
        const std::size_t end = at + s.sizes[i];
        if (s.sizes[i] > kMaxKeys || end > s.keys.size()) return {};
        for (std::size_t first = at; at < end; ++at) {
            const bool ascends = at == first || s.keys[at] > s.keys[at - 1];
            if (!ascends || s.keys[at] >= key_limit || s.counts[at] == 0) return {};
            out.add(i, s.keys[at], s.counts[at]);
        }
    }
    if (at != s.keys.size()) return {};
    for (std::size_t k = 0; k < s.dropped.size(); ++k) {
        const std::size_t pixel = s.dropped_at[k];
        if (pixel >= out.pixels() || s.sizes[pixel] != kMaxKeys || out.dropped(pixel) > 0)
            return {};
        out.pixels_[pixel].more->dropped = s.dropped[k];
    }
    return out;
}

std::size_t IdCoverage::bytes() const noexcept {
    std::size_t sum = pixels_.capacity() * sizeof(Pixel);
    for (const Pixel& p : pixels_)
        if (p.more) sum += sizeof(More) + p.more->counts.capacity() * sizeof(KeyCount);
    return sum;
}

}  // namespace tessera
