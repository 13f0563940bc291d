#pragma once
// The working spaces by their primaries, for headers and for telling a file's space from its
// header.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tessera {

/// CIE xy of R, G, B and white.
using Chromaticities = std::array<float, 8>;

inline constexpr Chromaticities kRec709Chromaticities{0.64f, 0.33f, 0.30f,   0.60f,
                                                      0.15f, 0.06f, 0.3127f, 0.3290f};
inline constexpr Chromaticities kAcescgChromaticities{0.713f, 0.293f, 0.165f,   0.830f,
                                                      0.128f, 0.044f, 0.32168f, 0.33767f};

/// "lin_rec709" and "acescg"; nothing for any other name.
std::optional<Chromaticities> chromaticities_of(std::string_view working_space);
/// The reverse, to within rounding; "" for other primaries.
std::string working_space_of(std::span<const float, 8> chromaticities);

}  // namespace tessera
