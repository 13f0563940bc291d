#pragma once
// What a file is, told from its first bytes, before any library parses it.

#include <cstdint>
#include <string>

namespace tessera {

enum class ImageFormat : std::uint8_t { png, jpeg, tiff, exr, hdr };

/// The format as a person writes it: "PNG".
const char* name_of(ImageFormat format) noexcept;

/// Throws Error(ExitCode::scene): "image 'a.png': cannot read: reason".
[[noreturn]] void fail_image(const std::string& path, const std::string& reason);

/// Throws like fail_image unless path is a readable regular file of one of the formats. Never
/// blocks (a FIFO or a device is refused).
ImageFormat sniff_image(const std::string& path);

/// Whether a file that could not be read claims, by its name or its first bytes, to be one of the
/// formats: it is broken then, rather than missing or of another kind.
bool claims_to_be_image(const std::string& path) noexcept;

}  // namespace tessera
