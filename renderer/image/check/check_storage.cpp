#include <algorithm>
#include <array>

#include "renderer/image/check/check_header.h"
#include "renderer/image/pass_names.h"

namespace tessera {
namespace {

// Root Z is depth; "motion.X" and "view.motion.X" are motion.
bool is_data(const RawPart& part, const RawChannel& channel) {
    const std::string layer = channel.layer();
    const std::string token = channel.token();
    if (layer.empty())
        return token == "Z" || (token.size() > 1 && is_data_pass(token)) ||
               is_data_pass(part.text("tessera/pass"));
    return is_data_pass(layer) || is_data_pass(layer.substr(layer.rfind('.') + 1));
}

bool is_matte(const RawChannel& channel) {
    const std::string layer = channel.layer();
    return is_cryptomatte_pass(layer) || is_cryptomatte_pass(layer.substr(layer.rfind('.') + 1));
}

bool holds_colour(const RawPart& part) {
    return std::any_of(part.channels.begin(), part.channels.end(),
                       [](const RawChannel& c) { return c.token() == "R" && !is_matte(c); });
}

void check_aces(const RawPart& part, ExrFindings& out) {
    if (!part.attributes.contains("acesImageContainerFlag")) return;
    const bool plain = std::all_of(part.channels.begin(), part.channels.end(), [](const auto& c) {
        return c.name.size() == 1 && std::string("RGBA").find(c.name) != std::string::npos;
    });
    if (!plain || part.compression != 0 || part.tiled)
        out.push_back({ExrRule::aces_flag, "file",
                       plain ? "it is compressed or tiled" : "it has other channels than R G B A"});
}

constexpr std::array kCodecs{"none",  "RLE", "ZIPS", "ZIP",  "PIZ",
                             "PXR24", "B44", "B44A", "DWAA", "DWAB"};

void check_channel(const RawPart& part, const RawChannel& c, ExrFindings& out) {
    const std::string codec = kCodecs[static_cast<std::size_t>(part.compression)];
    const bool lossy = part.lossy(c.type);
    if (is_matte(c)) {
        if (c.type != ExrType::real || lossy)
            out.push_back({ExrRule::matte_storage, where_channel(c),
                           c.type != ExrType::real ? "it is not float" : "it is under " + codec});
        return;
    }
    if (c.type == ExrType::integer)
        out.push_back({ExrRule::integer_id, where_channel(c), "its type is integer"});
    if (!is_data(part, c)) return;
    if (c.type == ExrType::half)
        out.push_back({ExrRule::half_data, where_channel(c), "its type is half"});
    if (lossy) out.push_back({ExrRule::lossy_data, where_channel(c), "it is under " + codec});
}

}  // namespace

std::string where_channel(const RawChannel& channel) { return "channel '" + channel.name + "'"; }

void check_storage(const RawExr& file, ExrFindings& out) {
    for (const RawPart& part : file.parts) {
        for (const RawChannel& channel : part.channels) check_channel(part, channel, out);
        check_aces(part, out);
    }
    for (const RawPart& part : file.parts) {
        if (!holds_colour(part) || part.attributes.contains("chromaticities")) continue;
        out.push_back({ExrRule::no_chromaticities, "file", "it has colours and no chromaticities"});
        break;
    }
}

}  // namespace tessera
