#pragma once
// Deep scanline files, line by line. What the file says of itself is checked before the library
// allocates for it.

#include <memory>
#include <string>

#include "renderer/image/deep_line.h"

namespace tessera {

class DeepReader {
public:
    /// Channels R, G, B, A, Z and, where there is one, ZBack of the file's first part. Throws
    /// Error(scene) naming the file.
    explicit DeepReader(const std::string& path);
    ~DeepReader();
    DeepReader(const DeepReader&) = delete;
    DeepReader& operator=(const DeepReader&) = delete;

    const std::string& path() const noexcept { return path_; }
    int width() const noexcept { return width_; }  // of the display window
    int height() const noexcept { return height_; }
    const PixelWindow& window() const noexcept { return window_; }
    /// Told from the chromaticities; Rec. 709 without any, "" for unknown ones.
    const std::string& working_space() const noexcept { return working_space_; }

    /// Line y of the window. Throws Error(scene) for what cannot be decoded, and for values that
    /// are no numbers, with their place. Depths may be infinite.
    void read(int y, DeepLine& line);

private:
    struct File;
    std::string path_, working_space_;
    int width_ = 0, height_ = 0;
    PixelWindow window_;
    std::unique_ptr<File> file_;
};

}  // namespace tessera
