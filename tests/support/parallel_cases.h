#pragma once
// Many cases of one test on all threads; what failed comes back as text, in the order of the cases.

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/core/parallel.h"

namespace tessera {

/// check(case) returns "" or what is wrong with it. The result is one line per bad case, "" if
/// there is none.
template <class Case, class Check>
std::string failures_of(const std::vector<Case>& cases, const Check& check) {
    std::vector<std::string> found(cases.size());
    Workers workers;
    workers.for_each(static_cast<int>(cases.size()),
                     [&](int i) { found[std::size_t(i)] = check(cases[std::size_t(i)]); });
    std::string all;
    for (const std::string& line : found) {
        if (!line.empty()) all += line + "\n";
    }
    return all;
}

}  // namespace tessera
