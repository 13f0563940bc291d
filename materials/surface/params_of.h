#pragma once
// Which input of a material is which parameter of its surface.

#include "materials/surface/params.h"
#include "renderer/api/scene_desc.h"

namespace tessera {

/// Calls visit(member of MaterialDesc, member of SurfaceParams) for each.
template <class Visit>
void visit_params(Visit visit) {
    using M = MaterialDesc;
    using P = SurfaceParams;
    visit(&M::base_weight, &P::base_weight);
    visit(&M::base_color, &P::base_color);
    visit(&M::base_diffuse_roughness, &P::base_diffuse_roughness);
    visit(&M::base_metalness, &P::base_metalness);
    visit(&M::specular_weight, &P::specular_weight);
    visit(&M::specular_color, &P::specular_color);
    visit(&M::specular_roughness, &P::specular_roughness);
    visit(&M::specular_roughness_anisotropy, &P::specular_roughness_anisotropy);
    visit(&M::specular_ior, &P::specular_ior);
    visit(&M::transmission_weight, &P::transmission_weight);
    visit(&M::transmission_color, &P::transmission_color);
    visit(&M::transmission_depth, &P::transmission_depth);
    visit(&M::transmission_scatter, &P::transmission_scatter);
    visit(&M::transmission_scatter_anisotropy, &P::transmission_scatter_anisotropy);
    visit(&M::transmission_dispersion_scale, &P::transmission_dispersion_scale);
    visit(&M::transmission_dispersion_abbe_number, &P::transmission_dispersion_abbe_number);
    visit(&M::subsurface_weight, &P::subsurface_weight);
    visit(&M::subsurface_color, &P::subsurface_color);
    visit(&M::subsurface_radius, &P::subsurface_radius);
    visit(&M::subsurface_radius_scale, &P::subsurface_radius_scale);
    visit(&M::subsurface_scatter_anisotropy, &P::subsurface_scatter_anisotropy);
    visit(&M::coat_weight, &P::coat_weight);
    visit(&M::coat_color, &P::coat_color);
    visit(&M::coat_roughness, &P::coat_roughness);
    visit(&M::coat_roughness_anisotropy, &P::coat_roughness_anisotropy);
    visit(&M::coat_ior, &P::coat_ior);
    visit(&M::coat_darkening, &P::coat_darkening);
    visit(&M::fuzz_weight, &P::fuzz_weight);
    visit(&M::fuzz_color, &P::fuzz_color);
    visit(&M::fuzz_roughness, &P::fuzz_roughness);
    visit(&M::thin_film_weight, &P::thin_film_weight);
    visit(&M::thin_film_thickness, &P::thin_film_thickness);
    visit(&M::thin_film_ior, &P::thin_film_ior);
}

}  // namespace tessera
