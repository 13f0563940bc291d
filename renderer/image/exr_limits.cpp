#include "renderer/image/exr_limits.h"

#include <ImfHeader.h>

#include <mutex>

namespace tessera {

void limit_exr_windows() {
    static std::once_flag once;
    std::call_once(once, [] {
        constexpr int kSide = 1 << 20;
        Imf::Header::setMaxImageSize(kSide, kSide);
        Imf::Header::setMaxTileSize(1 << 14, 1 << 14);
    });
}

}  // namespace tessera
