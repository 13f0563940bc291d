#pragma once
// "did you mean": the known name nearest to a mistyped one.

#include <span>
#include <string>
#include <string_view>

namespace tessera {

/// Edits between two words: insert, delete, replace, swap of neighbours. Stops counting above
/// limit.
int edit_distance(std::string_view a, std::string_view b, int limit);

/// The nearest of names, "" when none is near. A word also matches a part of a name cut at '_', so
/// that 'ruoghness' finds 'specular_roughness'. The first of equals wins.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

/// " (did you mean 'x'?)", or "" when nothing is near.
std::string did_you_mean(std::string_view word, std::span<const std::string> names);

}  // namespace tessera
