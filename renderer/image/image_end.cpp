#include "renderer/image/image_end.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

namespace tessera {
namespace {

constexpr int kEof = std::filebuf::traits_type::eof();

/// JPEG markers that stand alone: restarts, start of image, TEM, and the stuffed zero after a data
/// byte ff.
bool has_no_length(int marker) {
    return marker == 0x00 || marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
}

bool jpeg_ends(std::filebuf& file) {
    constexpr int kEnd = 0xd9;
    // Segments with a length are skipped whole: a thumbnail inside one has an end marker of its
    // own.
    for (int byte = file.sbumpc(); byte != kEof; byte = file.sbumpc()) {
        if (byte != 0xff) continue;
        int marker = file.sbumpc();
        while (marker == 0xff) marker = file.sbumpc();
        if (marker == kEof) return false;
        if (marker == kEnd) return true;
        if (has_no_length(marker)) continue;
        const int high = file.sbumpc();
        const int low = file.sbumpc();
        if (high == kEof || low == kEof) return false;
        for (int left = high * 256 + low - 2; left > 0; --left)
            if (file.sbumpc() == kEof) return false;
    }
    return false;
}

/// Walks the chunks (length, name, data, checksum) to IEND.
bool png_ends(std::filebuf& file) {
    const std::int64_t size = file.pubseekoff(0, std::ios::end, std::ios::in);
    std::int64_t at = 8;  // the signature
    while (at + 12 <= size) {
        std::array<char, 8> head{};
        file.pubseekpos(at, std::ios::in);
        if (file.sgetn(head.data(), 8) != 8) return false;
        std::int64_t length = 0;
        for (std::size_t i = 0; i < 4; ++i)
            length = length * 256 + static_cast<unsigned char>(head[i]);
        at += 12 + length;
        if (std::string_view(head.data() + 4, 4) == "IEND") return at <= size;
    }
    return false;
}

}  // namespace

bool reaches_end(const std::string& path, ImageFormat format) {
    if (format != ImageFormat::jpeg && format != ImageFormat::png) return true;
    std::filebuf file;
    if (!file.open(path, std::ios::in | std::ios::binary)) return false;
    return format == ImageFormat::jpeg ? jpeg_ends(file) : png_ends(file);
}

}  // namespace tessera
