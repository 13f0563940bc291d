#pragma once
// What fills a body of glass or of translucent matter.

#include "materials/surface/params.h"

namespace tessera {

/// Coefficients per scene unit, for red, green and blue.
struct Medium {
    Color extinction{0.0f};  // absorbed or scattered
    Color albedo{0.0f};      // the scattered share of it
    float anisotropy = 0;    // mean cosine, Henyey-Greenstein

    bool empty() const { return !(max_component(extinction) > 0.0f); }
    bool scatters() const { return max_component(albedo) > 0.0f; }
};

/// OpenPBR 1.1, "Translucent base": white light takes transmission_color over transmission_depth.
Medium transmission_medium(const SurfaceParams& p);

/// OpenPBR 1.1, "Subsurface": so that a half space of it looks like subsurface_color.
Medium subsurface_medium(const SurfaceParams& p);

/// The share of single scattering that makes a half space of albedo `color` (each in [0, 1]).
/// Kulla & Conty, "Revisiting Physically Based Shading at Imageworks", SIGGRAPH course 2017.
float single_scattering_albedo(float color, float anisotropy);

}  // namespace tessera
