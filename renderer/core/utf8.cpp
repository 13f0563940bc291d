#include "renderer/core/utf8.h"

#include <cstdint>

namespace tessera {
namespace {

struct Form {
    std::size_t followers;
    std::uint32_t bits, least;  // of the first byte; the first character that needs so many bytes
};

// followers > 3: no first byte of a character.
Form form_of(unsigned char c) noexcept {
    if (c < 0x80) return {0, c, 0};
    if (c >= 0xc0 && c < 0xe0) return {1, c & 0x1fu, 0x80};
    if (c >= 0xe0 && c < 0xf0) return {2, c & 0x0fu, 0x800};
    if (c >= 0xf0 && c < 0xf8) return {3, c & 0x07u, 0x10000};
    return {4, 0, 0};
}

}  // namespace

bool is_utf8(const std::string& text) noexcept {
    for (std::size_t i = 0; i < text.size();) {
        const Form form = form_of(static_cast<unsigned char>(text[i++]));
        if (form.followers > 3 || text.size() - i < form.followers) return false;
        std::uint32_t character = form.bits;
        for (std::size_t k = 0; k < form.followers; ++k) {
            const auto c = static_cast<unsigned char>(text[i++]);
            if ((c & 0xc0) != 0x80) return false;
            character = character << 6 | (c & 0x3fu);
        }
        const bool surrogate = character >= 0xd800 && character <= 0xdfff;
        if (character < form.least || character > 0x10ffff || surrogate) return false;
    }
    return true;
}

std::string as_utf8(const std::string& text) {
    if (is_utf8(text)) return text;
    std::string out;
    for (const char byte : text) {
        const auto c = static_cast<unsigned char>(byte);
        if (c < 0x80) {
            out += byte;
        } else {
            out += static_cast<char>(0xc0 | c >> 6);
            out += static_cast<char>(0x80 | (c & 0x3f));
        }
    }
    return out;
}

}  // namespace tessera
