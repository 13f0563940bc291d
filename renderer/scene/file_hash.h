#pragma once
// What is in a file, wherever it lies.

#include <cstdint>
#include <string>

namespace tessera {

/// A hash of the file's bytes; of more than 16 MiB, of its size and 256 pieces spread over it. Not
/// a regular file, or unreadable: 0.
std::uint64_t file_hash(const std::string& path);

}  // namespace tessera
