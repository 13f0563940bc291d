#include "materials/surface/openpbr.h"

#include <algorithm>

namespace tessera {

Ggx openpbr_ggx(float roughness, float anisotropy) {
    const float alpha = roughness * roughness;
    if (anisotropy == 0.0f) return {alpha, alpha};
    const float a = 1.0f - anisotropy;
    const float ax = alpha * std::sqrt(2.0f / (1.0f + a * a));
    // One axis may go to zero, the density may not.
    return {std::max(ax, kMinAlpha), std::max(a * ax, kMinAlpha)};
}

// Opaque bases look the same from both sides, so their boundary is always entered.
Surface::Surface(const SurfaceParams& params)
    : p(params),
      ggx(openpbr_ggx(p.specular_roughness, p.specular_roughness_anisotropy)),
      ior(modulated_ior(p.specular_ior, p.specular_weight)),
      boundary_eta(std::max(ior, 1.0f / ior)) {}

}  // namespace tessera
