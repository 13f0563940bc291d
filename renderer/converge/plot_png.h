#pragma once
// A drawing as pixels.

#include <string>

namespace tessera {

/// The PNG file, as bytes, of an SVG file's text, of `scale` pixels a unit. Throws Error(output)
/// where the library cannot.
std::string png_of_svg(const std::string& svg, double scale);

}  // namespace tessera
