#pragma once
// How far one path has come, against the limits of the scene.

#include <cstdint>

#include "materials/lobe.h"
#include "renderer/api/scene_desc.h"

namespace tessera {

struct PathDepth {
    std::uint16_t diffuse = 0, glossy = 0, transmission = 0;
    bool last = false;  // the ray may still find light, nothing more
    bool layers_done = false;

    /// The path is scattered by a lobe of a class, for the depth-th time counted from 0.
    void scatter(LobeClass cls, std::uint32_t depth, const RenderDesc& limits) noexcept {
        last = depth + 1 > static_cast<std::uint32_t>(limits.max_depth);
        switch (cls) {
            case LobeClass::subsurface:
            case LobeClass::diffuse:
                last |= ++diffuse > limits.max_diffuse_depth;
                break;
            case LobeClass::glossy:
                last |= ++glossy > limits.max_glossy_depth;
                break;
            case LobeClass::transmission:
                last |= ++transmission > limits.max_transmission_depth;
                break;
        }
    }
};

}  // namespace tessera
