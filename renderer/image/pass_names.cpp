#include "renderer/image/pass_names.h"

#include <algorithm>
#include <array>

namespace tessera {
namespace {

constexpr std::array<std::string_view, 9> kBeautyParts{"diffuse",      "specular", "coat",
                                                       "transmission", "sss",      "sheen",
                                                       "volume",       "emission", "background"};

constexpr std::array<std::string_view, 28> kData{"z",          "depth",        "depth_filtered",
                                                 "p",          "pref",         "position",
                                                 "n",          "ng",           "ns",
                                                 "normal",     "normals",      "uv",
                                                 "motion",     "vector",       "forward",
                                                 "backward",   "motionvector", "velocity",
                                                 "id",         "objectid",     "object_id",
                                                 "materialid", "material_id",  "indexob",
                                                 "indexma",    "variance",     "samplecount",
                                                 "time"};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](char c) { return lower(c); });
    return out;
}

bool drop_end(std::string_view& name, std::string_view end) {
    if (!name.ends_with(end)) return false;
    name.remove_suffix(end.size());
    return true;
}

}  // namespace

std::span<const std::string_view> beauty_parts() noexcept { return kBeautyParts; }

bool is_colour_pass(const std::string& name) noexcept {
    std::string_view part = name;
    if (part == "beauty" || part.starts_with("RGBA_")) return true;
    if (drop_end(part, "albedo")) return true;
    drop_end(part, "_indirect") || drop_end(part, "_direct");
    return std::find(kBeautyParts.begin(), kBeautyParts.end(), part) != kBeautyParts.end();
}

bool is_data_pass(std::string_view name) noexcept {
    return is_cryptomatte_pass(name) ||
           std::find(kData.begin(), kData.end(), lower(name)) != kData.end();
}

bool is_cryptomatte_pass(std::string_view name) noexcept {
    return lower(name.substr(0, 6)) == "crypto";
}

}  // namespace tessera
