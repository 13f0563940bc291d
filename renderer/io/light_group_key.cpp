#include "renderer/io/light_group_key.h"

#include <algorithm>
#include <cctype>

namespace tessera {

bool is_group_name(const std::string& name) {
    constexpr std::size_t kLongest = 26;  // with "RGBA_" 31, which is what Blender reads
    const auto is_word = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    };
    return !name.empty() && name.size() <= kLongest &&
           std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
           std::all_of(name.begin(), name.end(), is_word) && name != "left" && name != "right" &&
           !name.ends_with("_left") && !name.ends_with("_right") && name != "default";
}

}  // namespace tessera
