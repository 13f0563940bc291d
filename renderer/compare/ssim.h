#pragma once
// Structural similarity: Wang, Bovik, Sheikh, Simoncelli, "Image Quality Assessment: From Error
// Visibility to Structural Similarity", IEEE TIP 13(4), 2004.

#include <optional>
#include <span>
#include <vector>

#include "renderer/compare/picture_view.h"
#include "renderer/core/parallel.h"

namespace tessera {

inline constexpr int kSsimWindow = 11;

/// Mean over all windows of 11 x 11 pixels (Gaussian weights, sigma 1.5) that lie inside; nothing
/// for smaller pictures. One channel of values for the eye, 0 black to 1 white.
std::optional<double> ssim(const PictureView& a, const PictureView& b, Workers& workers);

/// encoded: as a display is given it. compressed: exposed first, then y / (1 + y) (Reinhard, Stark,
/// Shirley, Ferwerda, "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, eq. 3).
enum class ShownAs : unsigned char { encoded, compressed };

/// The luminance y of linear Rec. 709 (interleaved RGB) in sRGB's curve.
std::vector<float> shown_luminance(std::span<const float> rgb, ShownAs how, double exposure);
/// Brings the reference's mean luminance to 0.18.
double exposure_of(std::span<const float> reference_rgb) noexcept;

}  // namespace tessera
