#pragma once
// What `tessera converge` measures of pictures, and shows of them.

#include <optional>
#include <string>

#include "renderer/converge/record.h"

namespace tessera {

/// The errors of a picture's beauty; its heat maps as JPEG where they are asked for. Throws
/// Error(scene).
struct Measured {
    TrueError truth;
    std::string relative, flip;
};
Measured measure(const std::string& picture, const std::string& reference, int threads, bool maps,
                 const std::string& folder);

/// A picture as PNG, for the eye. folder: for a file on the way. Throws Error(scene).
std::string as_png(const std::string& picture, const std::string& folder);

struct PictureFrame {
    int width = 0, height = 0;
    bool encoded = false;  // integers as a display takes them
};
/// Throws Error(scene).
PictureFrame frame_of(const std::string& picture);

}  // namespace tessera
