#include "renderer/image/working_space.h"

#include <cmath>

namespace tessera {
namespace {

bool near(std::span<const float, 8> a, const Chromaticities& b) {
    for (std::size_t i = 0; i < 8; ++i)
        if (!(std::abs(a[i] - b[i]) < 1e-3f)) return false;  // files round to three or four digits
    return true;
}

}  // namespace

std::optional<Chromaticities> chromaticities_of(std::string_view working_space) {
    if (working_space == "lin_rec709") return kRec709Chromaticities;
    if (working_space == "acescg") return kAcescgChromaticities;
    return std::nullopt;
}

std::string working_space_of(std::span<const float, 8> chromaticities) {
    if (near(chromaticities, kRec709Chromaticities)) return "lin_rec709";
    if (near(chromaticities, kAcescgChromaticities)) return "acescg";
    return "";
}

}  // namespace tessera
