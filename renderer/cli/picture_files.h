#pragma once
// The files that a finished picture goes to.

#include <string>

#include "renderer/api/deep.h"
#include "renderer/api/image.h"

namespace tessera {

struct PictureFiles {
    std::string output;  // .exr, or a film file, which is not written here
    std::string preview, view;
    OutputDesc format;
    bool sidecar_manifests = false;
    int threads = 0;
};

/// Pads the picture if the format says so, and writes all. Throws Error(output).
WriteReport write_picture_files(LayeredImage& image, const PictureFiles& files);

/// Writes the depths of a picture whose header says everything by now, and adds to its report.
void write_deep_file(const LayeredImage& image, DeepImage& deep, const std::string& path,
                     const WriteOptions& options, WriteReport& report);

/// "a.exr", "a.exr and 3 more"
std::string names(const std::vector<std::string>& files);

/// Throws Error(usage) for a view that there is not: before hours of rendering, not after.
void check_view(const std::string& working_space, const std::string& view);

}  // namespace tessera
