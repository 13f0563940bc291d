#pragma once
// Errors as colours.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tessera {

/// From black at 0 to white at 1, brighter all the way: Green, "A colour scheme for the display of
/// astronomical intensity images", Bull. Astr. Soc. India 39, 2011 (start 0.5, rotations -1.5, hue
/// 1, gamma 1).
std::array<float, 3> cubehelix(float t) noexcept;

/// 8-bit RGB of each value, 0 to 1; values that are not finite are magenta, which the map has not.
std::vector<std::uint8_t> heat_map(std::span<const float> values);

/// Relative errors on a scale of kLeastShown (0) to kMostShown (1), logarithmic.
inline constexpr float kLeastShown = 1e-3f, kMostShown = 10;
std::vector<float> on_log_scale(std::span<const float> relative_errors);

}  // namespace tessera
