#pragma once
// What a scalar input takes of a texel.

#include "materials/lobe.h"
#include "renderer/api/scene_desc.h"
#include "renderer/image/texture.h"

namespace tessera {

inline float channel_of(const Texel& t, Channel channel) {
    switch (channel) {
        case Channel::r:
            return t[0];
        case Channel::g:
            return t[1];
        case Channel::b:
            return t[2];
        case Channel::a:
            return t[3];
        case Channel::luminance:
            return luminance({t[0], t[1], t[2]});
        case Channel::automatic:
            break;
    }
    return t[0];
}

}  // namespace tessera
