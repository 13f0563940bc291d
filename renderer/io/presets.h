#pragma once
// Materials that come with the program: materials/presets/*.toml, built in.

#include <span>
#include <string_view>

namespace tessera {

struct Preset {
    std::string_view name;
    std::string_view text;  // a scene file with [material.NAME]
};

/// By name.
std::span<const Preset> presets();

}  // namespace tessera
