#pragma once
// What can happen to light on its way, in the words of light path expressions: type, scattering and
// label of every event. Heckbert, "Adaptive Radiosity Textures for Bidirectional Ray Tracing",
// SIGGRAPH 1990; the spelling is Open Shading Language's.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tessera {

/// An event at a surface, or in what light passes through.
enum class LobeEvent : std::uint8_t {
    diffuse,
    sheen,
    sss,       // subsurface: in, about and out again are one event; also through thin sheets
    specular,  // rough reflection
    mirror,    // smooth reflection
    coat,
    coat_mirror,
    transmission,        // rough
    clear_transmission,  // smooth
    volume,
    count,
};
inline constexpr int kLobeEvents = static_cast<int>(LobeEvent::count);

struct EventName {
    char type;        // R, T or V
    char scattering;  // D, G or S
    std::string_view label;
};
inline constexpr std::array<EventName, kLobeEvents> kEventNames{{{'R', 'D', "diffuse"},
                                                                 {'R', 'D', "sheen"},
                                                                 {'T', 'D', "sss"},
                                                                 {'R', 'G', "specular"},
                                                                 {'R', 'S', "specular"},
                                                                 {'R', 'G', "coat"},
                                                                 {'R', 'S', "coat"},
                                                                 {'T', 'G', "transmission"},
                                                                 {'T', 'S', "transmission"},
                                                                 {'V', 'G', "volume"}}};

/// Where a path ends.
enum class LightType : std::uint8_t {
    light,         // a lamp: L
    object,        // a surface that shines: O
    background,    // the surroundings as the camera sees them: B
    surroundings,  // the surroundings as what lights surfaces: B and L
    count,
};
inline constexpr int kLightTypes = static_cast<int>(LightType::count);

/// What a light is called in expressions: by the group it is in, and by its own name.
struct LightTag {
    int group = 0;
    std::string group_name = "default";
    std::string name;
};

}  // namespace tessera
