#include "renderer/image/check/deep_chunks.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace tessera {
namespace {

constexpr std::uint64_t kMaxUnpacked = std::uint64_t(1) << 30;
constexpr std::uint64_t kMaxPixels = std::uint64_t(1) << 28;
constexpr std::uint64_t kZipMost = 1032;  // deflate cannot make more of a byte

// What stands before the data of a chunk of deep scanlines.
struct ChunkHead {
    std::int32_t y = 0;
    std::uint64_t table = 0, packed = 0, unpacked = 0;
};
constexpr std::size_t kHeadBytes = 28;

template <class T>
T value(const char* at) {
    T out;
    std::memcpy(&out, at, sizeof out);
    return out;
}

std::string at_line(std::int64_t y, const std::string& what) {
    return "line " + std::to_string(y) + ": " + what;
}

}  // namespace

std::string deep_damage(const std::string& path, const RawExr& file) {
    const RawPart& part = file.parts[0];
    if (part.compression != 0 && part.compression != 1 && part.compression != 2)
        return "deep files have no such codec";
    if (static_cast<std::uint64_t>(part.data.width() * part.data.height()) > kMaxPixels)
        return "it has more than 2^28 pixels";
    if (part.missing > 0)
        return "it is cut short: " + std::to_string(part.missing) + " of " +
               std::to_string(part.chunks) + " lines are missing";
    const bool multipart = file.parts.size() > 1;
    std::ifstream in(path, std::ios::binary);
    const std::uint64_t size = std::filesystem::file_size(path);
    const auto width = static_cast<std::uint64_t>(part.data.width());
    for (std::uint64_t i = 0; i < part.chunks; ++i) {
        std::array<char, kHeadBytes + 4> bytes{};
        const std::int64_t line = part.data.y0 + static_cast<std::int64_t>(i);
        in.seekg(static_cast<std::streamoff>(part.table + 8 * i));
        in.read(bytes.data(), 8);
        const std::uint64_t head = value<std::uint64_t>(bytes.data()) + (multipart ? 4 : 0);
        if (!in || head > size || size - head < kHeadBytes)
            return at_line(line, "it lies beyond the end of the file");
        in.seekg(static_cast<std::streamoff>(head));
        in.read(bytes.data(), kHeadBytes);
        const ChunkHead chunk{value<std::int32_t>(&bytes[0]), value<std::uint64_t>(&bytes[4]),
                              value<std::uint64_t>(&bytes[12]), value<std::uint64_t>(&bytes[20])};
        if (!in || chunk.y < part.data.y0 || chunk.y >= part.data.y1)
            return at_line(line, "it is no line of the picture");
        const std::uint64_t left = size - head - kHeadBytes;
        if (chunk.table > left || chunk.packed > left - chunk.table)
            return at_line(chunk.y, "it is cut short");
        if (chunk.table > 4 * width)
            return at_line(chunk.y, "its counts are of an impossible size");
        if (chunk.unpacked > kMaxUnpacked || chunk.unpacked / kZipMost > chunk.packed)
            return at_line(chunk.y, "its samples are of an impossible size");
    }
    return {};
}

}  // namespace tessera
