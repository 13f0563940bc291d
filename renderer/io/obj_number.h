#pragma once
// The numbers and corner indices of an OBJ line, checked before the parser reads them.

#include <cstdint>
#include <optional>
#include <string_view>

namespace tessera {

/// Whether word is a decimal number ("1", "-.5", "2.", "1e-002") of magnitude below 1e15: nothing
/// else is a coordinate (no nan, inf, hexadecimal, decimal comma).
bool is_coordinate(std::string_view word) noexcept;

/// The value of a word that is_coordinate.
double coordinate(std::string_view word) noexcept;

/// The indices of a face corner "v", "v/t", "v//n", "v/t/n" as written; 0 where one is missing.
struct ObjCornerText {
    std::int64_t position = 0, uv = 0, normal = 0;
};

/// Nothing when word is no corner. Values beyond 64 bits saturate.
std::optional<ObjCornerText> parse_corner(std::string_view word) noexcept;

}  // namespace tessera
