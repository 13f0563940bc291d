#pragma once
// Named arrays of plain numbers under a text that says what they are, with a checksum: what
// checkpoints and parts of pictures are made of. Little-endian: magic, sizes, table of arrays,
// text, arrays, XXH3 of all before it.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tessera {

struct NamedBytes {
    std::string name;
    std::span<const std::byte> bytes;
};

/// Writes beside `path`, reads back, renames; returns the size. Throws Error(ExitCode::output); the
/// file that was there stays then.
std::uint64_t write_array_file(const std::string& path, const std::string& header,
                               std::span<const NamedBytes> arrays);

/// Throws Error(ExitCode::scene) naming the file and what is wrong with it. Nothing larger than the
/// file is ever allocated.
class ArrayFile {
public:
    struct Entry {
        std::string name;
        std::uint64_t bytes = 0;
    };

    /// Reads the text and the table.
    explicit ArrayFile(const std::string& path);
    const std::string& path() const noexcept { return path_; }
    const std::string& header() const noexcept { return header_; }
    const std::vector<Entry>& arrays() const noexcept { return arrays_; }
    /// Reads all arrays into places of their sizes, in their order, and checks the sum. Once.
    void read(std::span<const std::span<std::byte>> into);
    /// Checks the sum alone. Instead of read().
    void check();
    [[noreturn]] void fail(const std::string& reason) const;

private:
    struct Close {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };
    struct Hash;
    struct FreeHash {
        void operator()(Hash* h) const;
    };

    void open();
    void read_bytes(void* to, std::size_t bytes);
    void read_table(std::uint32_t entries, std::uint32_t bytes);
    void check_sum();

    std::string path_, header_;
    std::vector<Entry> arrays_;
    std::uint64_t size_ = 0;
    std::unique_ptr<std::FILE, Close> file_;
    std::unique_ptr<Hash, FreeHash> hash_;
};

}  // namespace tessera
