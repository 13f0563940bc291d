#pragma once
// Light from all around: images of any projection, and the computed sky.

#include <optional>
#include <vector>

#include "renderer/lights/light.h"
#include "renderer/scene/emitters.h"

namespace tessera {

/// Nothing after an error, or where there is nothing to see.
std::optional<Light> make_environment(const EnvironmentDesc& desc, const EmitterInput& in);

/// The sky, and its sun if it is up.
std::vector<Light> make_sky(const SkyDesc& desc, const EmitterInput& in);

}  // namespace tessera
