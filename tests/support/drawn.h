#pragma once
// A lobe's sample as a value, for tests.

#include <optional>

#include "materials/lobe.h"

namespace tessera {

template <class Lobes>
std::optional<LobeSample> drawn(const Lobes& lobes, Vec3f wo, Vec2f u, float choice) {
    LobeSample s;
    return lobes.sample(wo, u, choice, s) ? std::optional(s) : std::nullopt;
}

}  // namespace tessera
