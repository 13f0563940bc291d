#include "renderer/image/colour_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace tessera {
namespace {

using Names = std::span<const std::string_view>;

constexpr std::array<std::string_view, 8> kLinRec709Names{
    kLinRec709,       "Linear Rec.709 (sRGB)",   "lin_srgb",      "lin_rec709_srgb",
    "Linear Rec.709", "Utility - Linear - sRGB", "Linear BT.709", "Linear"};
constexpr std::array<std::string_view, 3> kAcescgNames{kAcescg, "ACES - ACEScg", "lin_ap1"};
constexpr std::array<std::string_view, 6> kSrgbTextureNames{
    kSrgbTexture, "sRGB - Texture",           "sRGB",
    "srgb_tx",    "Utility - sRGB - Texture", "sRGB Encoded Rec.709 (sRGB)"};
constexpr std::array<std::string_view, 4> kAces2065Names{kAces2065, "ACES2065-1",
                                                         "ACES - ACES2065-1", "lin_ap0"};
constexpr std::array<std::string_view, 3> kLinRec2020Names{kLinRec2020, "Linear Rec.2020",
                                                           "Utility - Linear - Rec.2020"};
constexpr std::array<std::string_view, 4> kRawNames{kRaw, "data", "Non-Color", "Utility - Raw"};

constexpr std::array<Names, 6> kFamilies{kLinRec709Names, kAcescgNames,     kSrgbTextureNames,
                                         kAces2065Names,  kLinRec2020Names, kRawNames};

bool same_letters(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) ==
               std::tolower(static_cast<unsigned char>(y));
    });
}

/// Levenshtein distance, letter case aside.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = same_letters(a.substr(i - 1, 1), b.substr(j - 1, 1));
            const std::size_t replaced = diagonal + (same ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row[b.size()];
}

}  // namespace

std::span<const std::string_view> colour_family(std::string_view name) {
    for (const Names& family : kFamilies)
        for (const std::string_view known : family)
            if (same_letters(known, name)) return family;
    return {};
}

std::string own_name(const std::string& name) {
    const Names family = colour_family(name);
    return family.empty() ? name : std::string(family.front());
}

std::string nearest_name(const std::string& name, std::span<const std::string> candidates) {
    constexpr std::size_t kLongest = 100;  // nothing we know is that long
    if (name.size() > kLongest) return "";
    std::string best;
    std::size_t best_distance = name.size() / 2 + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t d = distance(name, candidate);
        if (d < best_distance) {
            best = candidate;
            best_distance = d;
        }
    }
    return best;
}

}  // namespace tessera
