#pragma once
// Coverage by names as layers and header attributes of a file: Cryptomatte 1.2.0.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/film/id_coverage.h"

namespace tessera {

inline constexpr int kCryptomatteLevels = 6;

/// What the file does not hold of what was seen.
struct CryptomatteLoss {
    std::uint64_t crowded_pixels = 0;  // of more names than levels
    std::uint64_t crowded_samples = 0;
    std::uint64_t dropped_pixels = 0;  // of more names than are counted
    std::uint64_t dropped_samples = 0;
};

/// Layers type00, type01 ... of R = id, G = coverage, B = the next id, A = its coverage; the
/// largest coverage first, of equal ones the smaller id. ids: by key; samples: taken, per pixel.
/// Coverages are rounded down, so that those of a pixel never sum to more than 1.
std::vector<Layer> cryptomatte_layers(const std::string& type, const IdCoverage& coverage,
                                      std::span<const std::uint32_t> ids,
                                      std::span<const std::uint32_t> samples,
                                      int levels = kCryptomatteLevels);
CryptomatteLoss cryptomatte_loss(const IdCoverage& coverage, int levels = kCryptomatteLevels);

/// {"name":"hex of the id"}, sorted by name. What is no UTF-8 in a name becomes U+FFFD.
std::string cryptomatte_manifest(std::span<const std::string> names);

/// The attributes name, hash, conversion and manifest of a type.
std::vector<std::pair<std::string, MetadataValue>> cryptomatte_header(
    const std::string& type, std::span<const std::string> names);

}  // namespace tessera
