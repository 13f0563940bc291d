#pragma once
// The colour spaces we know by name, and what other configs call them. The first name of a family
// is ours.

#include <span>
#include <string>
#include <string_view>

namespace tessera {

inline constexpr std::string_view kLinRec709 = "lin_rec709";
inline constexpr std::string_view kAcescg = "acescg";
inline constexpr std::string_view kSrgbTexture = "srgb_texture";
inline constexpr std::string_view kAces2065 = "aces2065_1";
inline constexpr std::string_view kLinRec2020 = "lin_rec2020";
inline constexpr std::string_view kRaw = "raw";

/// All names of the family that holds name (letter case aside); empty if none does.
std::span<const std::string_view> colour_family(std::string_view name);
/// The family's own name, or name itself for a space we do not know.
std::string own_name(const std::string& name);
/// The candidate nearest to name by edit distance, "" if all are far.
std::string nearest_name(const std::string& name, std::span<const std::string> candidates);

}  // namespace tessera
