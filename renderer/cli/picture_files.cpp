#include "renderer/cli/picture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "renderer/cli/manifest_files.h"
#include "renderer/cli/output_options.h"
#include "renderer/film/film_file.h"
#include "renderer/image/colour_space.h"

namespace tessera {
namespace {

// The whole frame, and overscan with it.
void pad_to_frame(LayeredImage& image) {
    const PixelWindow& w = image.window;
    const PixelWindow window{std::min(w.x0, 0), std::min(w.y0, 0), std::max(w.x1, image.width),
                             std::max(w.y1, image.height)};
    if (window != w) image = reframe(image, window);
}

}  // namespace

WriteReport write_picture_files(LayeredImage& image, const PictureFiles& files) {
    WriteReport report;
    if (files.format.crop_pad) pad_to_frame(image);
    if (names_film_file(files.output)) {
        std::error_code none;  // of a snapshot there is no film file
        report.bytes = std::filesystem::file_size(files.output, none);
        report.files = {files.output};
    } else {
        if (files.sidecar_manifests) write_manifests(move_manifests(image.metadata, files.output));
        report = write_exr(image, files.output, write_options(files.format, files.threads));
    }
    if (!files.preview.empty()) write_preview(image, files.preview, files.view);
    return report;
}

void write_deep_file(const LayeredImage& image, DeepImage& deep, const std::string& path,
                     const WriteOptions& options, WriteReport& report) {
    // Names of mattes are left to the file that has them.
    for (const auto& entry : image.metadata)
        if (!entry.first.starts_with("cryptomatte/")) deep.metadata.push_back(entry);
    const WriteReport written = write_deep_exr(deep, image.window, path, options);
    report.bytes += written.bytes;
    report.clamped += written.clamped;
    report.non_finite += written.non_finite;
    report.files.push_back(path);
}

std::string names(const std::vector<std::string>& files) {
    if (files.size() == 1) return files[0];
    return fmt::format("{} and {} more", files[0], files.size() - 1);
}

void check_view(const std::string& working_space, const std::string& view) {
    std::array<float, 3> pixel{};
    ColorSpaces(working_space).to_display(pixel, view);
}

}  // namespace tessera
