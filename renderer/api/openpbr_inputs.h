#pragma once
// The inputs of a material as a list: what reads, hashes, documents or compiles all of them goes by
// it.

#include "renderer/api/scene_desc.h"

namespace tessera {

struct OpenPbrInput {
    const char* name;
    double low, high;  // values of images are clamped to them, written ones must keep them
    const char* help;
};

/// Calls visit(member of MaterialDesc, OpenPbrInput) for each input, in OpenPBR's order. A member
/// is a FloatInput or a ColorInput.
template <class Visit>
void visit_openpbr(Visit visit) {
    using M = MaterialDesc;
    constexpr double kMany = 1e10, kThinnest = 0.01, kDensest = 100;
    const auto unit = [&](auto member, const char* name, const char* help) {
        visit(member, OpenPbrInput{name, 0, 1, help});
    };
    const auto range = [&](auto member, const char* name, double low, double high,
                           const char* help) {
        visit(member, OpenPbrInput{name, low, high, help});
    };
    unit(&M::base_weight, "base_weight", "Amount of the base.");
    unit(&M::base_color, "base_color", "Colour of the diffuse or metal base.");
    unit(&M::base_diffuse_roughness, "base_diffuse_roughness",
         "0 Lambert, 1 dusty: flat, bright at the edges.");
    unit(&M::base_metalness, "base_metalness", "0 dielectric, 1 metal.");

    range(&M::specular_weight, "specular_weight", 0, kMany,
          "Amount of the specular reflection; above 1 a dielectric reflects more than its index "
          "says.");
    unit(&M::specular_color, "specular_color",
         "Tint of the specular reflection; of a metal: its colour at the edge.");
    unit(&M::specular_roughness, "specular_roughness", "0 mirror, 1 dull.");
    unit(&M::specular_roughness_anisotropy, "specular_roughness_anisotropy",
         "Stretch of the highlight along the tangent.");
    range(&M::specular_ior, "specular_ior", kThinnest, kDensest, "Index of refraction.");

    unit(&M::transmission_weight, "transmission_weight", "0 opaque, 1 glass.");
    unit(&M::transmission_color, "transmission_color",
         "Tint of what passes through: at each boundary, or after transmission_depth.");
    range(
        &M::transmission_depth, "transmission_depth", 0, kMany,
        "Way inside, in scene units, after which white light has transmission_color; 0: tinted at "
        "the boundary.");
    unit(&M::transmission_scatter, "transmission_scatter",
         "Milkiness: what is scattered inside over transmission_depth.");
    range(&M::transmission_scatter_anisotropy, "transmission_scatter_anisotropy", -1, 1,
          "-1 scatters back, 0 alike, 1 on.");
    unit(&M::transmission_dispersion_scale, "transmission_dispersion_scale",
         "Amount of dispersion: 1 that of the Abbe number.");
    range(&M::transmission_dispersion_abbe_number, "transmission_dispersion_abbe_number", 1, 1000,
          "Abbe number: the lower the more colour (diamond 55, flint glass 30).");

    unit(&M::subsurface_weight, "subsurface_weight", "0 opaque, 1 translucent body.");
    unit(&M::subsurface_color, "subsurface_color", "Colour of the translucent body.");
    range(&M::subsurface_radius, "subsurface_radius", 0, kMany,
          "Mean free path inside, scene units.");
    unit(&M::subsurface_radius_scale, "subsurface_radius_scale",
         "Factor on it for red, green and blue.");
    range(&M::subsurface_scatter_anisotropy, "subsurface_scatter_anisotropy", -1, 1,
          "-1 scatters back, 0 alike, 1 on.");

    unit(&M::coat_weight, "coat_weight", "Amount of the clear coat.");
    unit(&M::coat_color, "coat_color", "Colour that the coat gives what lies below.");
    unit(&M::coat_roughness, "coat_roughness", "0 mirror, 1 dull.");
    unit(&M::coat_roughness_anisotropy, "coat_roughness_anisotropy",
         "Stretch of the coat's highlight.");
    range(&M::coat_ior, "coat_ior", kThinnest, kDensest, "Index of refraction of the coat.");
    unit(&M::coat_darkening, "coat_darkening",
         "How far the base darkens by reflection inside the coat.");

    unit(&M::fuzz_weight, "fuzz_weight", "Amount of fuzz: velvet, dust.");
    unit(&M::fuzz_color, "fuzz_color", "Colour of the fuzz.");
    unit(&M::fuzz_roughness, "fuzz_roughness", "0 upright fibres, 1 in disorder.");

    unit(&M::thin_film_weight, "thin_film_weight", "Amount of the thin film.");
    range(&M::thin_film_thickness, "thin_film_thickness", 0, 100, "Thickness in micrometres.");
    range(&M::thin_film_ior, "thin_film_ior", kThinnest, kDensest,
          "Index of refraction of the film.");

    range(&M::emission_luminance, "emission_luminance", 0, 1e20,
          "Emitted luminance, cd/m2 (nits); 179 of them are 1 W/m2/sr.");
    range(&M::emission_color, "emission_color", 0, kMany, "Factor on the emission.");

    unit(&M::geometry_opacity, "geometry_opacity", "0 cut out, 1 there.");

    // Ours.
    range(&M::bump, "bump", -kMany, kMany,
          "Height over the surface in the object's units, for its normal only.");
}

/// Those that move the surface before it is traced.
template <class Visit>
void visit_displacement(Visit visit) {
    using M = MaterialDesc;
    constexpr double kMany = 1e10;
    visit(&M::displacement, OpenPbrInput{"displacement", -kMany, kMany,
                                         "Height along the normal, times displacement_scale; of "
                                         "meshes with subdivision."});
    visit(&M::vector_displacement,
          OpenPbrInput{"vector_displacement", -kMany, kMany,
                       "Three numbers, times displacement_scale, in displacement_space."});
}

/// All of the above.
template <class Visit>
void visit_inputs(Visit visit) {
    visit_openpbr(visit);
    visit_displacement(visit);
}

}  // namespace tessera
