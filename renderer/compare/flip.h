#pragma once
// FLIP, the difference that an eye sees when two pictures alternate. Andersson, Nilsson,
// Akenine-Möller, Oskarsson, Åström, Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020; for light beyond a display's range Andersson, Nilsson, Shirley,
// Akenine-Möller, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021.

#include <vector>

#include "renderer/compare/picture_view.h"
#include "renderer/core/parallel.h"

namespace tessera {

/// A 4K screen 0.7 m wide, seen from 0.7 m.
inline constexpr double kPixelsPerDegree = 67;

/// Of each pixel, 0 no difference to 1. Three channels of linear Rec. 709, clamped to 0..1: what a
/// display shows.
std::vector<float> ldr_flip(const PictureView& a, const PictureView& reference,
                            double pixels_per_degree, Workers& workers);

/// The exposures in stops at which HDR-FLIP looks, told from the reference alone.
std::vector<double> flip_exposures(const PictureView& reference);

/// Scene light: the greatest LDR-FLIP of all those exposures.
std::vector<float> hdr_flip(const PictureView& a, const PictureView& reference,
                            double pixels_per_degree, Workers& workers);

}  // namespace tessera
