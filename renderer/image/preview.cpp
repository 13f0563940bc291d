#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <new>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/image/atomic_file.h"
#include "renderer/image/colour_space.h"

namespace tessera {
namespace {

/// OpenImageIO's name of the format that the file's extension asks for.
const char* format_of(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".png") return "png";
    if (extension == ".jpg" || extension == ".jpeg") return "jpeg";
    throw Error(ExitCode::usage,
                path + ": unknown kind of preview '" + extension + "', must end in .png or .jpg");
}

/// Root R,G,B over black. The colours are premultiplied, so leaving alpha out is all there is to
/// do, and a background with alpha 0 shows.
std::vector<float> beauty_of(const LayeredImage& image, const std::string& path) {
    const PixelWindow& w = image.window;
    for (const Layer& layer : image.layers) {
        std::size_t index[3];
        bool found = layer.name.empty();
        for (std::size_t c = 0; c < 3; ++c) {
            const auto at =
                std::find(layer.channels.begin(), layer.channels.end(), std::string(1, "RGB"[c]));
            found = found && at != layer.channels.end();
            index[c] = static_cast<std::size_t>(at - layer.channels.begin());
        }
        if (!found) continue;
        const std::size_t stride = layer.channels.size();
        if (w.x1 <= w.x0 || w.y1 <= w.y0 ||
            layer.pixels.size() !=
                static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height()) * stride)
            throw Error(ExitCode::bug, "write_preview: the beauty does not fill its window");
        std::vector<float> rgb(layer.pixels.size() / stride * 3);
        for (std::size_t i = 0; i < rgb.size(); ++i)
            rgb[i] = layer.pixels[i / 3 * stride + index[i % 3]];
        return rgb;
    }
    fail_output(path, "the picture has no beauty layer (R, G, B)");
}

/// The file's bytes. Encoded in memory, because the library's close() hides errors of the disk.
std::vector<unsigned char> encode(const std::vector<unsigned char>& pixels, int width, int height,
                                  const char* format, const std::string& path) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto out = OIIO::ImageOutput::create(format);
    if (!out || !out->supports("ioproxy"))
        fail_output(path, std::string("no writer for ") + format);
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("CompressionQuality", 95);
    spec.attribute("jpeg:subsampling", "4:4:4");
    out->set_ioproxy(&memory);
    if (!out->open(path, spec) || !out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) ||
        !out->close())
        fail_output(path, out->geterror());
    return bytes;
}

}  // namespace

void write_preview(const LayeredImage& image, const std::string& path, const std::string& view) {
    const char* const format = format_of(path);
    try {
        std::vector<float> rgb = beauty_of(image, path);
        ColorSpaces(image.working_space).to_display(rgb, view);
        std::vector<unsigned char> pixels(rgb.size());
        std::transform(rgb.begin(), rgb.end(), pixels.begin(),
                       [](float v) { return static_cast<unsigned char>(v * 255 + 0.5f); });
        const std::vector<unsigned char> bytes =
            encode(pixels, image.window.width(), image.window.height(), format, path);
        AtomicFile file(path);
        file.write(bytes.data(), bytes.size());
        if (file.finish() != bytes.size()) fail_output(path, "read back with another size");
        file.commit();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::memory, path + ": cannot write: out of memory");
    } catch (const std::exception& error) {
        fail_output(path, error.what());
    }
}

}  // namespace tessera
