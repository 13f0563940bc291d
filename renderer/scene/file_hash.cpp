#include "renderer/scene/file_hash.h"

#include <xxhash.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

namespace tessera {

std::uint64_t file_hash(const std::string& path) {
    constexpr std::uint64_t kWhole = std::uint64_t{16} << 20, kPieces = 256, kPiece = 4096;
    std::error_code failed;
    if (!std::filesystem::is_regular_file(path, failed)) return 0;
    const std::uint64_t size = std::filesystem::file_size(path, failed);
    std::ifstream file(path, std::ios::binary);
    if (failed || !file) return 0;

    XXH64_hash_t hash = XXH3_64bits(&size, sizeof size);
    std::vector<char> bytes(std::min(size, kWhole));
    if (size <= kWhole) {
        file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return XXH3_64bits_withSeed(bytes.data(), bytes.size(), hash);
    }
    for (std::uint64_t i = 0; i < kPieces; ++i) {
        file.seekg(static_cast<std::streamoff>((size - kPiece) * i / (kPieces - 1)));
        file.read(bytes.data(), kPiece);
        hash = XXH3_64bits_withSeed(bytes.data(), kPiece, hash);
    }
    return hash;
}

}  // namespace tessera
