#pragma once

namespace tessera {

/// What a film keeps beside its passes.
struct FilmExtras {
    bool deep = false;        // beauty apart by depth
    bool replicates = false;  // beauty apart by replicate, which tells its error
    bool operator==(const FilmExtras&) const = default;
};

}  // namespace tessera
