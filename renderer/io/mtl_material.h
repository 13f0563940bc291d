#pragma once
// One MTL material as OpenPBR; docs/mtl-mapping.md is the table.

#include <functional>
#include <string>

#include "renderer/io/mtl_normalise.h"
#include "renderer/io/obj_parse.h"

namespace tessera {

struct MtlContext {
    std::string name;
    const MtlBlock* block = nullptr;
    Tally* tally = nullptr;
    /// Index of the texture in the scene, -1 when it may not be read.
    std::function<int(const MtlTexture&, std::uint32_t line)> texture;
};

/// Values that cannot be are brought into range with a located warning.
MaterialDesc map_mtl(MtlValues values, const MtlContext& context);

/// Roughness whose square is the GGX width that matches Phong's exponent: alpha = sqrt(2 / (Ns +
/// 2)).
float roughness_from_phong(float ns) noexcept;

}  // namespace tessera
