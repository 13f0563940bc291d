#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "renderer/image/check/check_header.h"

namespace tessera {
namespace {

constexpr std::size_t kMaxName = 31;

std::string lower(std::string text) {
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    return text;
}

bool known_to_blender(const std::string& token) {
    const std::string t = lower(token);
    return t.size() == 1
               ? t.find_first_of("rgbaxyzwuv") == 0
               : t == "red" || t == "green" || t == "blue" || t == "alpha" || t == "depth";
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_stereo(const std::string& layer) {
    const std::string l = lower(layer);
    for (const std::string side : {"left", "right"}) {
        if (l == side || l.starts_with(side + ".") || l.starts_with(side + "_") ||
            l.ends_with("_" + side) || l.ends_with("." + side))
            return true;
    }
    return false;
}

std::string as_nuke(std::string layer) {
    for (char& c : layer) {
        const bool plain = is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        if (!plain) c = '_';
    }
    return layer;
}

void check_layer(const std::string& layer, std::size_t channels, bool views, ExrFindings& out) {
    const std::string where = "layer '" + layer + "'";
    if (!layer.empty() && (channels == 2 || channels > 4))
        out.push_back({ExrRule::magenta_layer, where, fmt::format("it has {} channels", channels)});
    if (std::count(layer.begin(), layer.end(), '.') > 1)
        out.push_back({ExrRule::many_dots, where, "it is nested too deep"});
    if (!views && is_stereo(layer))
        out.push_back({ExrRule::stereo_name, where, "it reads as a view"});
    if (!layer.empty() && is_digit(layer[0]))
        out.push_back({ExrRule::leading_digit, where, "it begins with a digit"});
}

// Blender meets the names of all parts in one place.
void check_parts(const RawExr& file, ExrFindings& out) {
    int bare = 0;
    for (const RawPart& part : file.parts) {
        bare += std::any_of(part.channels.begin(), part.channels.end(),
                            [](const RawChannel& c) { return c.layer().empty(); });
    }
    if (bare > 1)
        out.push_back({ExrRule::bare_names_in_parts, "file",
                       fmt::format("{} parts have channels like R or X", bare)});
}

}  // namespace

void check_names(const RawExr& file, ExrFindings& out) {
    std::map<std::string, std::size_t> layers;
    bool views = false;
    for (const RawPart& part : file.parts) {
        views = views || part.attributes.contains("multiView") || part.attributes.contains("view");
        for (const RawChannel& c : part.channels) {
            ++layers[c.layer()];
            if (!known_to_blender(c.token()))
                out.push_back({ExrRule::unknown_token, where_channel(c),
                               "its last word is '" + c.token() + "'"});
            if (c.name.size() > kMaxName)
                out.push_back({ExrRule::long_name, where_channel(c),
                               fmt::format("{} characters", c.name.size())});
        }
    }
    std::map<std::string, std::string> nuke;
    for (const auto& [layer, channels] : layers) {
        check_layer(layer, channels, views, out);
        const auto [same, fresh] = nuke.emplace(as_nuke(layer), layer);
        if (!fresh)
            out.push_back({ExrRule::name_clash, "layer '" + layer + "'",
                           "Nuke cannot tell it from '" + same->second + "'"});
    }
    check_parts(file, out);
}

}  // namespace tessera
