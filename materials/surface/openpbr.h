#pragma once
// OpenPBR Surface 1.1, the part that exists now: its parameters at one point, and the lobes they
// make. Andersson et al., "OpenPBR Surface Specification", Academy Software Foundation, 2024.

#include "materials/energy.h"
#include "materials/lobe_list.h"

namespace tessera {

/// Parameters at a point, textures read.
struct SurfaceParams {
    Color base_color{0.8f};  // base_weight included
    float base_metalness = 0;
    float specular_weight = 1;
    Color specular_color{1.0f};
    float specular_roughness = 0.3f;
    float specular_roughness_anisotropy = 0;
    float specular_ior = 1.5f;
    float transmission_weight = 0;
    Color transmission_color{1.0f};
    bool thin_walled = false;
    const ReflectionAlbedoCurve* boundary =
        nullptr;  // of the dielectric boundary if it is the same everywhere
};

/// Index of the opaque base's boundary, always entered from outside: at least 1.
float openpbr_boundary_eta(const SurfaceParams& p);

/// Roughness to the two GGX alphas. OpenPBR 1.1, "Microfacet model".
Ggx openpbr_ggx(float roughness, float anisotropy);

/// The lobes seen from wo (wo.z > 0); front: wo is on the outside. Ready to sample.
LobeList openpbr_lobes(const SurfaceParams& p, Vec3f wo, bool front) noexcept;

}  // namespace tessera
