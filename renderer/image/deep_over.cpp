#include <half.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/deep_line.h"

namespace tessera {
namespace {

// Nothing is behind: below any share of a sample, above the rounding of sums.
constexpr double kNothing = 1e-9;

struct Rounding {
    bool half;
    WriteReport& report;

    float opacity(double a, bool last) const {
        if (last) return 1.0f;
        // Of what is not the last one something must be left.
        const float below_1 = half ? 1.0f - 0x1p-11f : 1.0f - 0x1p-24f;
        return std::min(round(std::clamp(a, 0.0, 1.0)), below_1);
    }
    float colour(double c) const {
        if (!std::isfinite(c)) {
            ++report.non_finite;
            return 0.0f;
        }
        if (half && c > HALF_MAX) {
            ++report.clamped;
            return HALF_MAX;
        }
        return round(std::max(c, 0.0));
    }
    float round(double v) const {
        const auto f = static_cast<float>(v);
        return half ? static_cast<float>(Imath::half(f)) : f;
    }
};

}  // namespace

void append_over(std::span<const DeepSample> shares, bool half, DeepLine& out,
                 WriteReport& report) {
    const Rounding rounding{half, report};
    double left = 1, covered = 0;  // as the file has it; as it was meant
    std::array<double, 3> meant{}, stored{};
    for (const DeepSample& s : shares) {
        DeepValue v{s.z, s.z, {}};
        covered += s.alpha;
        const bool last = 1 - covered < kNothing;
        if (s.alpha > 0) v.rgba[3] = rounding.opacity((covered - (1 - left)) / left, last);
        for (std::size_t c = 0; c < 3; ++c) {
            meant[c] += static_cast<double>(s.rgb[c]);
            v.rgba[c] = rounding.colour((meant[c] - stored[c]) / left);
            stored[c] += left * static_cast<double>(v.rgba[c]);
        }
        left *= 1 - static_cast<double>(v.rgba[3]);
        out.values.push_back(v);
    }
    out.counts.push_back(static_cast<std::uint32_t>(shares.size()));
}

}  // namespace tessera
