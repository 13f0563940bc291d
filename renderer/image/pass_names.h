#pragma once
// What is known of passes by their usual names, ours or another renderer's.

#include <span>
#include <string>
#include <string_view>

namespace tessera {

/// Passes that sum to beauty, one without its _direct and _indirect where both exist.
std::span<const std::string_view> beauty_parts() noexcept;

/// Depth, positions, normals, motion, ids, mattes, variance: what only float without loss keeps.
bool is_data_pass(std::string_view name) noexcept;
bool is_cryptomatte_pass(std::string_view name) noexcept;

}  // namespace tessera
