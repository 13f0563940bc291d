#pragma once
// What OBJ and MTL text have in common: bytes from disk, encodings, logical lines, names with
// comments.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tessera {

/// The bytes of a regular file, or why it cannot be read. A file beyond max_bytes or half of this
/// machine's memory is refused before it is read: text takes more memory than its size once it is
/// parsed. So is one with a line beyond 64 MiB, which is no text.
struct FileBytes {
    std::string bytes;
    std::string error;  // empty: read
};
FileBytes read_regular_file(const std::string& path, std::uint64_t max_bytes = ~std::uint64_t{0});

/// Drops a UTF-8 byte order mark and turns UTF-16 with a mark into UTF-8.
std::string to_utf8(std::string bytes);

/// Lines ended by LF, CRLF or CR, with those that end in '\' joined to the next.
class LineReader {
public:
    explicit LineReader(std::string_view text, std::uint32_t first_line = 1);

    /// The next logical line without its end; valid until the next call. Nothing at the end.
    std::optional<std::string_view> next();
    /// Number of the (first) physical line of what next() returned.
    std::uint32_t line() const noexcept { return line_; }
    /// Where the line that next() returned begins in the text.
    std::size_t offset() const noexcept { return offset_; }

private:
    std::string_view physical_line();
    std::size_t find_from(char c, std::size_t from) const noexcept;

    std::string_view text_;
    std::size_t at_ = 0;
    std::size_t offset_ = 0;
    std::uint32_t line_ = 0;
    std::uint32_t next_line_ = 1;
    std::size_t lf_ =
        0;  // where the next LF and CR stand, at or after at_; the text's size if nowhere
    std::size_t cr_ = 0;
    std::string joined_;
};

inline bool is_blank(char c) noexcept { return c == ' ' || c == '\t'; }

/// Without blanks and NUL bytes at both ends.
std::string_view trim(std::string_view text) noexcept;

/// The first word and what follows it, both trimmed.
struct WordSplit {
    std::string_view word, rest;
};
WordSplit split_word(std::string_view text) noexcept;

/// A name as users mean it: trimmed, and without a trailing " # comment" (but "Material #25" is a
/// name: a digit right after the '#').
std::string_view clean_name(std::string_view text) noexcept;

/// ASCII lower case.
std::string to_lower(std::string_view text);

}  // namespace tessera
