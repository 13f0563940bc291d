#include "renderer/image/eight_bit.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "renderer/api/error.h"
#include "renderer/image/atomic_file.h"

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

/// The file's bytes. Encoded in memory, because the library's close() hides errors of the disk.
std::vector<unsigned char> encode(std::span<const unsigned char> pixels, int width, int height,
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

void check_eight_bit(const std::string& path) { format_of(path); }

void write_eight_bit(std::span<const unsigned char> rgb, int width, int height,
                     const std::string& path) {
    const std::vector<unsigned char> bytes = encode(rgb, width, height, format_of(path), path);
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    if (file.finish() != bytes.size()) fail_output(path, "read back with another size");
    file.commit();
}

}  // namespace tessera
