#pragma once
// A comparison as a table and as JSON.

#include <string>
#include <vector>

#include "renderer/cli/compare_limits.h"

namespace tessera {

std::string as_text(const Comparison& comparison);

/// docs/compare.md describes it. failures: what exceeded() told.
std::string as_json(const Comparison& comparison, const std::vector<Limit>& limits,
                    const std::vector<std::string>& failures);

}  // namespace tessera
