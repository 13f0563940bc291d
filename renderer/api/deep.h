#pragma once
// Deep pictures: several depths a pixel, each with its colour and opacity, and their way to disk
// and back to a flat picture. docs/files.md says what lies in the files.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/api/image.h"

namespace tessera {

/// Where a pixel shows nothing: the depth of its background, whose alpha is 0.
inline constexpr float kDeepBackground = 1e10f;

/// One depth of a pixel, and what the camera sees of it: what lies in front is already taken off,
/// so that a pixel's samples add up to beauty.
struct DeepSample {
    float z = 0;  // of the nearest camera sample
    std::array<float, 3> rgb{};
    double alpha = 0;  // share of the camera samples
    bool operator==(const DeepSample&) const = default;
};

struct DeepImage {
    int width = 0, height = 0;  // display window
    PixelWindow window;
    std::string working_space = "lin_rec709";
    std::vector<std::uint32_t> counts;  // per pixel of the window, row-major from the top
    std::vector<DeepSample> samples;    // pixel after pixel, nearest first
    std::vector<std::pair<std::string, MetadataValue>> metadata;
};

/// Writes a deep scanline EXR of R, G, B, A, Z over a part of the image's window (what the image
/// lacks has no samples), ZIPS or uncompressed, beside its target, reads it back and renames it. In
/// the file samples are as `over` wants them: not lessened by what lies in front. Throws
/// Error(output).
WriteReport write_deep_exr(const DeepImage& image, const PixelWindow& window,
                           const std::string& path, const WriteOptions& options);

/// Merges deep files by depth and composites them: beauty, and Z as render writes it. Of several
/// backgrounds a pixel shows that of the first file that has the pixel. Throws Error(scene) for
/// files that are damaged or do not belong together.
LayeredImage flatten_deep_exr(std::span<const std::string> paths);

}  // namespace tessera
