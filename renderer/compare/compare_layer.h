#pragma once
// Two layers of one name against each other.

#include <functional>
#include <string>

#include "renderer/compare/flip.h"
#include "renderer/compare/metric.h"
#include "renderer/compare/value_counts.h"

namespace tessera {

/// What a layer's values mean, and with that, which metrics say something of it: colours all, data
/// (depth, normals) rmse, max_abs, different and non_finite, ids whether they are the same.
enum class LayerContent : std::uint8_t { colour, data, ids };

struct LayerPair {
    std::vector<std::string> channels;
    LayerContent content = LayerContent::colour;
    PictureView a, reference;
};

/// Interleaved RGB to linear Rec. 709, in place; an empty one leaves it as it is.
using ToLight = std::function<void(std::span<float>)>;

struct CompareOptions {
    std::optional<double> epsilon;  // of relMSE; otherwise as scale_of() tells
    double pixels_per_degree = kPixelsPerDegree;
    /// Values between 0 and 1 as a display takes them, rather than scene light.
    bool encoded = false;
    ToLight a_to_light, reference_to_light;
    bool maps = false;
};

struct ChannelScores {
    std::string name;
    ValueCounts a, reference;
    std::optional<double> mean_ratio;  // of A's mean to the reference's, of colours
};

struct LayerScores {
    PerMetric<std::optional<double>> values;
    std::vector<ChannelScores> channels;
    std::uint64_t pixels = 0;
    std::optional<double> epsilon, psnr_peak;
    /// If maps were asked for, for each pixel: relative error and FLIP (of colours; NaN where a
    /// value is not finite), of ids 0, or what no error exceeds.
    std::vector<float> relative, flip;
};

/// Alpha counts for max_abs, different and non_finite only.
LayerScores compare_layer(const LayerPair& pair, const CompareOptions& options, Workers& workers);

}  // namespace tessera
