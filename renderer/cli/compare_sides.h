#pragma once
// Pictures against their reference, layer by layer, over the seeds of each side.

#include <optional>
#include <string>
#include <vector>

#include "renderer/cli/compare_files.h"
#include "renderer/compare/seed_interval.h"

namespace tessera {

/// One side's scores of a layer, over its files.
struct SideScores {
    PerMetric<std::optional<SeedInterval>> values;
    /// Counts are sums over the files, ratios means; those of the reference are its own.
    std::vector<ChannelScores> channels;
};

struct ComparedLayer {
    std::string title;
    LayerContent content = LayerContent::colour;
    std::uint64_t pixels = 0;
    std::optional<double> epsilon, psnr_peak;
    std::vector<SideScores> sides;  // A, and B if there is a reference beside it
};

/// A layer ("N") or a channel ("beauty.A") that only one of two files has.
struct LonePart {
    std::string name, file;
};

/// What a heat map is made of: the first file of a side.
struct ErrorMaps {
    std::string layer;
    int width = 0, height = 0;
    std::vector<std::vector<float>> relative, flip;  // by side
};

struct Comparison {
    std::vector<std::vector<std::string>> sides;  // files of A, and of B
    std::string reference;                        // a file
    int width = 0, height = 0;
    bool encoded = false, seeds = false;  // seeds: both sides can be told apart by intervals
    std::string working_space;
    std::vector<ComparedLayer> layers;
    std::vector<LonePart> lone;
    std::vector<std::string> notes;
    ErrorMaps maps;
};

struct CompareRequest {
    std::vector<std::vector<std::string>> sides;
    std::string reference;
    std::vector<std::string> layers;  // empty: all that they have
    std::optional<double> epsilon;
    double pixels_per_degree = kPixelsPerDegree;
    bool maps = false;  // of the first layer
    int threads = 0;
};

/// Throws Error(scene) naming the file: unreadable, another frame, no layer in common.
Comparison compare_pictures(const CompareRequest& request);

}  // namespace tessera
