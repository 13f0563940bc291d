#pragma once
// Hue, saturation and value, and the colour of what glows.

#include "renderer/core/vec.h"

namespace tessera {

/// Hue in [0, 1), saturation, value. Smith, "Color Gamut Transform Pairs", SIGGRAPH 1978.
Vec3f rgb_to_hsv(Color c);
/// Hue of any number: turns do not count.
Color hsv_to_rgb(Vec3f hsv);

/// Linear Rec.709 of a black body, luminance one; kelvin within 800 to 25000. Planck's law over the
/// CIE observer.
Color blackbody_color(float kelvin);

}  // namespace tessera
