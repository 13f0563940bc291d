#pragma once
// The parameters of OpenPBR Surface 1.1 at one point, textures read. Andersson et al., "OpenPBR
// Surface Specification", Academy Software Foundation, 2024; names, units and defaults are its own.

#include "renderer/core/vec.h"

namespace tessera {

struct SurfaceParams {
    float base_weight = 1;
    Color base_color{0.8f};
    float base_diffuse_roughness = 0;
    float base_metalness = 0;

    float specular_weight = 1;
    Color specular_color{1.0f};
    float specular_roughness = 0.3f;
    float specular_roughness_anisotropy = 0;
    float specular_ior = 1.5f;

    float transmission_weight = 0;
    Color transmission_color{1.0f};
    float transmission_depth = 0;  // scene units in which white light takes transmission_color
    Color transmission_scatter{0.0f};
    float transmission_scatter_anisotropy = 0;
    float transmission_dispersion_scale = 0;
    float transmission_dispersion_abbe_number = 20;

    float subsurface_weight = 0;
    Color subsurface_color{0.8f};
    float subsurface_radius = 1;  // scene units
    Color subsurface_radius_scale{1.0f, 0.5f, 0.25f};
    float subsurface_scatter_anisotropy = 0;

    float coat_weight = 0;
    Color coat_color{1.0f};
    float coat_roughness = 0;
    float coat_roughness_anisotropy = 0;
    float coat_ior = 1.6f;
    float coat_darkening = 1;

    float fuzz_weight = 0;
    Color fuzz_color{1.0f};
    float fuzz_roughness = 0.5f;

    float thin_film_weight = 0;
    float thin_film_thickness = 0.5f;  // micrometres
    float thin_film_ior = 1.4f;

    bool thin_walled = false;
};

}  // namespace tessera
