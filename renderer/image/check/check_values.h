#pragma once
// What can be told from the values of single channels and layers.

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/image/check/exr_rules.h"
#include "renderer/image/check/exr_strips.h"

namespace tessera {

/// How often something was met, and where first.
struct Tally {
    std::uint64_t count = 0;
    std::int64_t x = 0, y = 0;

    void add(const ExrStripView& strip, std::size_t pixel) {
        if (count++ > 0) return;
        x = strip.x0 + static_cast<std::int64_t>(pixel) % strip.width;
        y = strip.y0 + static_cast<std::int64_t>(pixel) / strip.width;
    }
};
/// "12 pixels, the first at 3,4".
std::string to_string(const Tally& tally);

class ValueCheck {
public:
    explicit ValueCheck(const RawExr& file);
    void look(const ExrStripView& strip);
    void tell(ExrFindings& out) const;

private:
    enum Kind { nan, infinite, negative, limit, alpha, kinds };
    struct ChannelState {
        std::size_t part = 0, channel = 0;
        bool colour = false, alpha = false, depth = false;
        std::array<Tally, kinds> tally{};
    };
    struct BeautyState {  // R G B A of one layer
        std::size_t part = 0;
        std::array<std::size_t, 4> channel{};
        Tally tally;
    };
    struct NormalState {
        std::string layer;
        std::size_t part = 0;
        std::array<std::size_t, 3> channel{};
        std::uint64_t normals = 0;
        Tally too_long, odd;
    };
    void look(const ExrStripView& strip, ChannelState& state) const;
    static void look(const ExrStripView& strip, BeautyState& state);
    static void look(const ExrStripView& strip, NormalState& state);

    const RawExr& file_;
    std::vector<ChannelState> channels_;
    std::vector<BeautyState> beauties_;
    std::vector<NormalState> normals_;
};

}  // namespace tessera
