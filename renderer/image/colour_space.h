#pragma once
// Colour conversion through OpenColorIO. The config: $OCIO if set, else a small one made in code
// from OCIO's built-in transforms (no files). OCIO is started at the first call that needs it, not
// before.

#include <memory>
#include <span>
#include <string>

namespace tessera {

class ColorSpaces {
public:
    /// working_space: "lin_rec709" or "acescg" (aliases of a user's config are tried: role
    /// scene_linear, common names). Throws Error(ExitCode::scene) when the config cannot be read or
    /// lacks the space.
    explicit ColorSpaces(const std::string& working_space);
    ~ColorSpaces();
    ColorSpaces(const ColorSpaces&) = delete;
    ColorSpaces& operator=(const ColorSpaces&) = delete;

    /// rgb (3 interleaved floats a pixel) from the named space to the working space, in place.
    /// "" or the working space itself or a data space ("raw", "data") leave them alone.
    /// Throws Error naming the space and the nearest known name.
    void to_working(std::span<float> rgb, const std::string& from) const;

    /// True if `from` is sRGB texture space and the working space shares its primaries: a
    /// per-channel curve (our LUT, equal to OCIO's result) then does, and OCIO stays asleep.
    bool is_plain_srgb(const std::string& from) const;

    /// Working space to a display view, in place, encoded 0..1. view "" = the config's default
    /// view.
    void to_display(std::span<float> rgb, const std::string& view) const;

    /// Whether OCIO was started (for the statistics).
    bool awake() const noexcept;
    /// CIE xy of R, G, B and white of the working space: 8 floats, for the EXR header.
    std::span<const float> chromaticities() const noexcept;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// sRGB electro-optical transfer function (IEC 61966-2-1), for 8-bit look-up tables.
float srgb_to_linear(float encoded) noexcept;

}  // namespace tessera
