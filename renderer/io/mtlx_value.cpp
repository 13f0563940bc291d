#include "renderer/io/mtlx_value.h"

#include <array>
#include <charconv>
#include <cmath>

namespace tessera {
namespace {

constexpr std::array<std::string_view, 11> kNames{"boolean", "integer",  "float",   "color3",
                                                  "color4",  "vector2",  "vector3", "vector4",
                                                  "string",  "filename", "other"};

}  // namespace

MtlxType mtlx_type(std::string_view name) {
    for (std::size_t i = 0; i < kNames.size(); ++i)
        if (kNames[i] == name) return static_cast<MtlxType>(i);
    return MtlxType::other;
}

std::string_view name_of(MtlxType type) { return kNames[static_cast<std::size_t>(type)]; }

int width_of(MtlxType type) {
    switch (type) {
        case MtlxType::boolean:
        case MtlxType::integer:
        case MtlxType::scalar:
            return 1;
        case MtlxType::vector2:
            return 2;
        case MtlxType::color3:
        case MtlxType::vector3:
            return 3;
        case MtlxType::color4:
        case MtlxType::vector4:
            return 4;
        default:
            return 0;
    }
}

std::optional<std::vector<float>> mtlx_numbers(std::string_view text) {
    std::vector<float> out;
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto skip = [&] {
        while (at < end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) ++at;
    };
    for (skip(); at < end && out.size() < 16; skip()) {
        if (!out.empty()) {
            if (*at != ',') return std::nullopt;
            ++at;
            skip();
        }
        if (at < end && *at == '+') ++at;
        float number = 0;
        const auto [next, failed] = std::from_chars(at, end, number);
        if (failed != std::errc() || !std::isfinite(number)) return std::nullopt;
        out.push_back(number);
        at = next;
    }
    if (at < end || out.empty()) return std::nullopt;
    return out;
}

std::string mtlx_color_space(const MtlxElement& element) {
    const std::string* name = element.inherited("colorspace");
    if (!name || *name == "none") return "";
    // The names that MaterialX 1.39 takes over from the Color Interop Forum.
    if (*name == "srgb_rec709_scene") return "srgb_texture";
    if (*name == "lin_rec709_scene") return "lin_rec709";
    if (*name == "lin_ap1_scene") return "acescg";
    return *name;
}

}  // namespace tessera
