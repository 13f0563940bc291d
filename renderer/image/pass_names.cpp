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

}  // namespace

std::span<const std::string_view> beauty_parts() noexcept { return kBeautyParts; }

bool is_data_pass(std::string_view name) noexcept {
    return is_cryptomatte_pass(name) ||
           std::find(kData.begin(), kData.end(), lower(name)) != kData.end();
}

bool is_cryptomatte_pass(std::string_view name) noexcept {
    return lower(name.substr(0, 6)) == "crypto";
}

}  // namespace tessera
