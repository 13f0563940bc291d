#pragma once
// TOML text to a tree of values. The only part that sees the parser.

#include <string>
#include <string_view>

#include "renderer/io/scene_value.h"

namespace tessera {

/// text: a TOML document; file: the name its places carry. Throws Error(scene) with the place of a
/// syntax error, of nesting beyond 32 levels, and of more than 4 million values.
Value parse_toml(std::string_view text, const std::string& file);

/// The value of "key = text" for one value written on a command line, every place in it being
/// `origin` without line and column. Throws Error(usage) when text is no TOML value.
Value parse_toml_value(std::string_view text, const std::string& origin);

}  // namespace tessera
