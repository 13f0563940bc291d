#pragma once

#include <cstdint>

namespace tessera {

/// What a film keeps beside its passes.
struct FilmExtras {
    bool deep = false;        // beauty apart by depth
    bool replicates = false;  // beauty apart by replicate, and probes, which tell its error
    std::uint64_t seed = 0;   // of the probes' places
    bool operator==(const FilmExtras&) const = default;
};

}  // namespace tessera
