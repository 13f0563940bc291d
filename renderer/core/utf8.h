#pragma once
// Names as text that every reader takes.

#include <string>

namespace tessera {

/// Whether it is UTF-8 (RFC 3629): no overlong forms, no surrogates, nothing above U+10FFFF.
bool is_utf8(const std::string& text) noexcept;

/// The text itself if it is UTF-8; otherwise its bytes are taken for Latin-1, as what older
/// programs write mostly is.
std::string as_utf8(const std::string& text);

}  // namespace tessera
