#include "renderer/io/obj_text.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace tessera {
namespace {

void append_utf8(std::string& out, std::uint32_t code) {
    const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xC0 | code >> 6);
        put(0x80 | (code & 63));
    } else if (code < 0x10000) {
        put(0xE0 | code >> 12);
        put(0x80 | (code >> 6 & 63));
        put(0x80 | (code & 63));
    } else {
        put(0xF0 | code >> 18);
        put(0x80 | (code >> 12 & 63));
        put(0x80 | (code >> 6 & 63));
        put(0x80 | (code & 63));
    }
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<unsigned char>(bytes[i]);
        const auto second = static_cast<unsigned char>(bytes[i + 1]);
        return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
    };
    std::string out;
    out.reserve(bytes.size() / 2);
    for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
        std::uint32_t code = unit(i);
        const bool high = code >= 0xD800 && code < 0xDC00;
        if (high && i + 3 < bytes.size()) {
            const std::uint32_t low = unit(i + 2);
            if (low >= 0xDC00 && low < 0xE000) {
                code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
                i += 2;
            }
        }
        append_utf8(out, code >= 0xD800 && code < 0xE000 ? 0xFFFD : code);
    }
    return out;
}

constexpr std::size_t kChunk = std::size_t{16} << 20, kLongestLine = std::size_t{64} << 20;

std::uint64_t machine_memory() {
    const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0
               ? static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page)
               : ~std::uint64_t{0};
}

std::string mib(std::uint64_t bytes) { return std::to_string(bytes >> 20) + " MiB"; }

}  // namespace

FileBytes read_regular_file(const std::string& path, std::uint64_t max_bytes) {
    // O_NONBLOCK: a FIFO must not hang the open before fstat can refuse it.
    const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return {{}, std::strerror(errno)};
    struct Closer {
        int fd;
        ~Closer() { ::close(fd); }
    } closer{fd};
    struct stat info {};
    if (::fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) return {{}, "not a regular file"};
    const std::uint64_t limit = std::min(max_bytes, machine_memory() / 2);
    const auto size = static_cast<std::uint64_t>(info.st_size);
    if (size > limit)
        return {{}, "it has " + mib(size) + ", at most " + mib(limit) + " are read here"};
    std::string bytes;
    bytes.reserve(size);
    std::size_t line_start = 0;  // of the line that the last chunk ended in
    while (bytes.size() < size) {
        const std::size_t filled = bytes.size();
        const std::size_t chunk = std::min<std::size_t>(size - filled, kChunk);
        bytes.resize(filled + chunk);
        ssize_t got = 0;
        do got = ::read(fd, bytes.data() + filled, chunk);
        while (got < 0 && errno == EINTR);
        if (got < 0) return {{}, std::strerror(errno)};
        bytes.resize(filled + static_cast<std::size_t>(got));
        if (got == 0) break;
        const std::size_t end = bytes.find_last_of("\n\r");
        if (end != std::string::npos) line_start = end + 1;
        if (bytes.size() - line_start > kLongestLine)
            return {{}, "a line of it is longer than " + mib(kLongestLine) + ", which no text has"};
    }
    return {std::move(bytes), {}};
}

std::string to_utf8(std::string bytes) {
    if (bytes.starts_with("\xEF\xBB\xBF")) return bytes.erase(0, 3);
    if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes, true);
    if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes, false);
    return bytes;
}

LineReader::LineReader(std::string_view text, std::uint32_t first_line)
    : text_(text), next_line_(first_line), lf_(find_from('\n', 0)), cr_(find_from('\r', 0)) {}

std::size_t LineReader::find_from(char c, std::size_t from) const noexcept {
    if (from >= text_.size()) return text_.size();
    const void* found = std::memchr(text_.data() + from, c, text_.size() - from);
    return found ? static_cast<std::size_t>(static_cast<const char*>(found) - text_.data())
                 : text_.size();
}

std::string_view LineReader::physical_line() {
    const std::size_t begin = at_;
    const std::size_t end = std::min(lf_, cr_);
    at_ = std::min(end + (cr_ < lf_ && lf_ == cr_ + 1 && lf_ < text_.size() ? 2 : 1), text_.size());
    if (lf_ < at_) lf_ = find_from('\n', at_);
    if (cr_ < at_) cr_ = find_from('\r', at_);
    ++next_line_;
    return text_.substr(begin, end - begin);
}

std::optional<std::string_view> LineReader::next() {
    if (at_ >= text_.size()) return std::nullopt;
    line_ = next_line_;
    offset_ = at_;
    std::string_view line = physical_line();
    if (!line.ends_with('\\')) return line;
    joined_.clear();
    while (line.ends_with('\\')) {
        joined_.append(line.substr(0, line.size() - 1));
        joined_ += ' ';
        line = at_ < text_.size() ? physical_line() : std::string_view();
    }
    joined_.append(line);
    return std::string_view(joined_);
}

std::string_view trim(std::string_view text) noexcept {
    const auto empty = [](char c) { return is_blank(c) || c == '\0'; };
    while (!text.empty() && empty(text.front())) text.remove_prefix(1);
    while (!text.empty() && empty(text.back())) text.remove_suffix(1);
    return text;
}

WordSplit split_word(std::string_view text) noexcept {
    text = trim(text);
    const std::size_t length = std::min(text.find_first_of(" \t"), text.size());
    return {text.substr(0, length), trim(text.substr(length))};
}

std::string_view clean_name(std::string_view text) noexcept {
    text = trim(text);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '#' || (i > 0 && !is_blank(text[i - 1]))) continue;
        const bool number =
            i > 0 && i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
        if (!number) return trim(text.substr(0, i));
    }
    return text;
}

std::string to_lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return out;
}

}  // namespace tessera
