#pragma once
// The passes of a picture: which there are, what lies in their channels, and which sets of them
// have a name.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/api/image.h"

namespace tessera {

/// Where a pass's values come from, and so how its samples become a pixel.
enum class PassSource : std::uint8_t {
    z,      // depth of the nearest sample
    depth,  // mean depth of the samples that hit
    p,      // of the nearest sample, as are the next two
    pref,
    uv,
    n,  // means over the samples that hit
    ng,
    facing,
    albedo,        // colours: means over all samples
    event_albedo,  // of the first surface's lobes of some events
    light_paths,   // light whose paths an expression takes
    shadow,        // light that shadows took from the first surface
    shadow_matte,  // share of it
    ao,
    object_id,  // of the nearest sample
    material_id,
    crypto_object,  // coverage by names
    crypto_material,
    crypto_asset,
    sample_count,
    seconds,
    variance,
    standard_error,
};

struct Pass {
    std::string name;                   // of the layer; "" = root of the file
    std::vector<std::string> channels;  // as they are called there
    LayerKind kind = LayerKind::color;
    PassSource source{};
    std::string expression;    // of light_paths
    std::uint32_t events = 0;  // of event_albedo: bits of LobeEvent
    int group = -1;            // of light_paths: of these lights alone; -1: of all
};

/// What a user asked for beyond beauty, in the file's order.
using Passes = std::vector<Pass>;

/// A ready-made pass, as `--list-aovs` shows it.
struct PassInfo {
    std::string_view name, channels;
    PassSource source;
    LayerKind kind;
    std::string_view expression;
    std::uint32_t events;
    std::string_view meaning;
};
std::span<const PassInfo> ready_passes();

/// A named set of passes.
struct PassPreset {
    std::string_view name, passes, meaning;  // names, separated by blanks
};
std::span<const PassPreset> pass_presets();

/// Reads what --aov and film.aovs take: names of passes and presets, "NAME = EXPRESSION",
/// "light_groups" and "NAME@groups". groups: names of the light groups, "default" first. Throws
/// Error with loc and the nearest known name: scene if loc is a line of one, else usage.
Passes choose_passes(const std::vector<std::string>& names, const std::vector<std::string>& groups,
                     const SourceLoc& loc);

/// Whether any pass needs what only light paths or shadow rays can say.
bool needs_path(const Passes& passes);

}  // namespace tessera
