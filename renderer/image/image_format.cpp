#include "renderer/image/image_format.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "renderer/api/error.h"

namespace tessera {
namespace {

using namespace std::string_view_literals;

struct Magic {
    std::string_view bytes;
    ImageFormat format;
};

constexpr std::array kMagics{
    Magic{"\x89PNG\r\n\x1a\n"sv, ImageFormat::png},
    Magic{"\xff\xd8\xff"sv, ImageFormat::jpeg},
    Magic{"II*\0"sv, ImageFormat::tiff},
    Magic{"MM\0*"sv, ImageFormat::tiff},
    Magic{"II+\0"sv, ImageFormat::tiff},
    Magic{"MM\0+"sv, ImageFormat::tiff},
    Magic{"\x76\x2f\x31\x01"sv, ImageFormat::exr},
    Magic{"#?RADIANCE"sv, ImageFormat::hdr},
    Magic{"#?RGBE"sv, ImageFormat::hdr},
};

/// The first bytes of a regular file. O_NONBLOCK: opening a FIFO must not wait for its writer.
std::string first_bytes(const std::string& path) {
    const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0) fail_image(path, std::generic_category().message(errno));
    struct stat info {};
    const bool regular = ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
    char head[16];
    const ssize_t count = regular ? ::read(fd, head, sizeof head) : 0;
    ::close(fd);
    if (!regular) fail_image(path, S_ISDIR(info.st_mode) ? "it is a folder" : "not a regular file");
    if (count < 0) fail_image(path, "it cannot be read from the disk");
    if (count == 0) fail_image(path, "the file is empty");
    return std::string(head, static_cast<std::size_t>(count));
}

}  // namespace

const char* name_of(ImageFormat format) noexcept {
    switch (format) {
        case ImageFormat::png:
            return "PNG";
        case ImageFormat::jpeg:
            return "JPEG";
        case ImageFormat::tiff:
            return "TIFF";
        case ImageFormat::exr:
            return "OpenEXR";
        case ImageFormat::hdr:
            return "Radiance HDR";
    }
    return "";
}

void fail_image(const std::string& path, const std::string& reason) {
    throw Error(ExitCode::scene, "image '" + path + "': cannot read: " + reason);
}

ImageFormat sniff_image(const std::string& path) {
    if (path.find('\0') != std::string::npos)
        fail_image(path.c_str(), "the name holds a zero byte");
    const std::string head = first_bytes(path);
    for (const Magic& magic : kMagics)
        if (head.starts_with(magic.bytes)) return magic.format;
    fail_image(path, "not one of PNG, JPEG, TIFF, OpenEXR, Radiance HDR");
}

bool claims_to_be_image(const std::string& path) noexcept {
    constexpr std::array kExtensions{".png"sv,  ".jpg"sv, ".jpeg"sv, ".tif"sv,
                                     ".tiff"sv, ".exr"sv, ".hdr"sv};
    try {
        if (!std::filesystem::is_regular_file(path)) return false;
        std::string extension = std::filesystem::path(path).extension().string();
        for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
        if (std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end())
            return true;
        sniff_image(path);
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace tessera
