#pragma once
// Between an MTL file and the parser: cuts the file into materials, and rewrites one material so
// that the parser reads what its author meant (grey from one value, keys in any case, every option
// with all its values, slashes, no comments). Keys without a meaning here are reported once each.

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "renderer/io/tally.h"

namespace tessera {

/// Where a material stands in the text of its file.
struct MtlSection {
    std::size_t begin = 0, end = 0;  // from the newmtl line up to the next
    std::uint32_t line = 0;          // of newmtl
};

/// Materials by name; of two with one name the first counts, the other is told to the tally.
std::unordered_map<std::string, MtlSection> index_mtl(std::string_view text, Tally& tally);

/// One material as the parser gets it.
struct MtlBlock {
    std::string text;
    std::map<std::string, std::uint32_t, std::less<>> given;  // key in its usual spelling -> line
};

/// seen: the unknown and unsupported keys reported so far (for one file).
MtlBlock normalise_mtl(std::string_view text, const MtlSection& section, Tally& tally,
                       std::set<std::string, std::less<>>& seen);

}  // namespace tessera
