#pragma once
// What a comparison may come to: --fail-above, --fail-below.

#include <string>
#include <vector>

#include "renderer/cli/compare_sides.h"

namespace tessera {

struct Limit {
    std::string layer;  // empty: every layer that the metric is measured in
    Metric metric = Metric::rmse;
    bool above = true;  // fails above the value, otherwise below
    double value = 0;
    std::string text;  // the option as it was given
};

/// "relmse=0.01", "beauty:flip=0.05". Throws Error(usage): an unknown metric, no number, and PSNR
/// or SSIM, which are better the greater, above a value (or the others below one).
Limit parse_limit(const std::string& text, bool above);

/// One line for each way in which the comparison exceeds a limit; empty if it keeps them all. What
/// could not be measured fails too: layers that one file has alone, pixels that are not finite
/// (unless those are to be ignored). Throws Error(usage) for a limit that nothing is measured by.
std::vector<std::string> exceeded(const Comparison& comparison, const std::vector<Limit>& limits,
                                  bool ignore_non_finite);

}  // namespace tessera
