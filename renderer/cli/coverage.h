#pragma once
// How often the intervals that renders give for their errors hold the true ones.

#include "renderer/cli/scene_options.h"

namespace tessera {

struct CoverageOptions {
    int seeds = 0;              // renders; 0: none
    int reference_spp = 16384;  // of the picture that stands for the truth
};

/// Prints a table: how many of the renders called each number reliable, of those in how many the
/// interval held the true number, and how often a render that claimed to have reached a target was
/// wrong by more than half.
int run_coverage(const SceneOptions& scene, const CoverageOptions& options);

}  // namespace tessera
