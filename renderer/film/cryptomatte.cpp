#include "renderer/film/cryptomatte.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "renderer/core/murmur3.h"

namespace tessera {
namespace {

std::string hex(std::uint32_t bits) {
    char text[9];
    std::snprintf(text, sizeof text, "%08x", bits);
    return text;
}

struct Rank {
    std::uint32_t id, count;
};

bool comes_first(const Rank& a, const Rank& b) {
    return a.count != b.count ? a.count > b.count : a.id < b.id;
}

float share_rounded_down(std::uint32_t count, std::uint32_t samples) {
    if (count >= samples) return 1.0f;
    const double share = static_cast<double>(count) / samples;
    const float nearest = static_cast<float>(share);
    return static_cast<double>(nearest) > share ? std::nextafter(nearest, 0.0f) : nearest;
}

}  // namespace

std::vector<Layer> cryptomatte_layers(const std::string& type, const IdCoverage& coverage,
                                      std::span<const std::uint32_t> ids,
                                      std::span<const std::uint32_t> samples, int levels) {
    std::vector<Layer> layers;
    for (int i = 0; i < (levels + 1) / 2; ++i) {
        char number[12];
        std::snprintf(number, sizeof number, "%02d", i);
        layers.push_back({type + number,
                          {"R", "G", "B", "A"},
                          LayerKind::data,
                          std::vector<float>(coverage.pixels() * 4)});
    }
    std::array<KeyCount, IdCoverage::kMaxKeys> counts;
    std::array<Rank, IdCoverage::kMaxKeys> ranks;
    for (std::size_t pixel = 0; pixel < coverage.pixels(); ++pixel) {
        const std::size_t n = coverage.counts(pixel, counts);
        for (std::size_t i = 0; i < n; ++i) ranks[i] = {ids[counts[i].key], counts[i].count};
        const std::size_t shown = std::min(n, static_cast<std::size_t>(levels));
        std::partial_sort(ranks.begin(), ranks.begin() + shown, ranks.begin() + n, comes_first);
        for (std::size_t i = 0; i < shown; ++i) {
            float* out = &layers[i / 2].pixels[pixel * 4 + i % 2 * 2];
            out[0] = std::bit_cast<float>(ranks[i].id);
            out[1] = share_rounded_down(ranks[i].count, samples[pixel]);
        }
    }
    return layers;
}

CryptomatteLoss cryptomatte_loss(const IdCoverage& coverage, int levels) {
    CryptomatteLoss loss;
    const auto shown = static_cast<std::size_t>(levels);
    std::array<KeyCount, IdCoverage::kMaxKeys> counts;
    for (std::size_t pixel = 0; pixel < coverage.pixels(); ++pixel) {
        const std::size_t n = coverage.counts(pixel, counts);
        if (n > shown) {
            std::nth_element(counts.begin(), counts.begin() + shown, counts.begin() + n,
                             [](const auto& a, const auto& b) { return a.count > b.count; });
            ++loss.crowded_pixels;
            for (std::size_t i = shown; i < n; ++i) loss.crowded_samples += counts[i].count;
        }
        const std::uint32_t dropped = coverage.dropped(pixel);
        loss.dropped_pixels += dropped > 0;
        loss.dropped_samples += dropped;
    }
    return loss;
}

std::string cryptomatte_manifest(std::span<const std::string> names) {
    nlohmann::json manifest = nlohmann::json::object();
    for (const std::string& name : names) manifest[name] = hex(cryptomatte_id(name));
    return manifest.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<std::pair<std::string, MetadataValue>> cryptomatte_header(
    const std::string& type, std::span<const std::string> names) {
    // Seven digits: with them the longest attribute's name has no more than the 31 bytes that old
    // readers take.
    const std::string prefix = "cryptomatte/" + hex(murmur3(type)).substr(0, 7) + "/";
    return {{prefix + "name", type},
            {prefix + "hash", std::string("MurmurHash3_32")},
            {prefix + "conversion", std::string("uint32_to_float32")},
            {prefix + "manifest", cryptomatte_manifest(names)}};
}

}  // namespace tessera
