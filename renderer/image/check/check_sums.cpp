#include "renderer/image/check/check_sums.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "renderer/image/pass_names.h"

namespace tessera {
namespace {

// Each half is rounded by up to 2^-11 of itself; twice that of all that is added, and the smallest
// half for what is nearly black.
constexpr float kRelative = 0x1p-10f, kAbsolute = 1e-6f;

bool is_lossy(const RawExr& file, const ChannelSet& set) { return file.parts[set.part].lossy(); }

}  // namespace

SumCheck::SumCheck(const RawExr& file) : beauty_(find_channels(file, "", "RGB")) {
    if (!beauty_ || is_lossy(file, *beauty_)) return;
    add_passes(file);
    add_lights(file);
    std::erase_if(sums_, [&](const Sum& sum) {
        return std::any_of(sum.terms.begin(), sum.terms.end(),
                           [&](const ChannelSet& s) { return is_lossy(file, s); });
    });
}

// A file with some of the passes only is a choice, not a fault.
void SumCheck::add_passes(const RawExr& file) {
    Sum sum{ExrRule::sum_of_passes, "", {}, {}, 0, 0};
    std::set<std::string> bases;
    const auto add = [&](const std::string& layer) {
        const auto set = find_channels(file, layer, "RGB");
        if (!set) return false;
        sum.terms.push_back(*set);
        sum.names += (sum.names.empty() ? "" : " + ") + layer;
        return true;
    };
    for (const std::string_view part : beauty_parts()) {
        const std::string base(part);
        const bool direct = add(base + "_direct"), indirect = add(base + "_indirect");
        if ((direct && indirect) || (!direct && !indirect && add(base))) bases.insert(base);
    }
    for (const char* needed : {"diffuse", "specular", "emission", "background"})
        if (!bases.contains(needed)) return;
    sums_.push_back(std::move(sum));
}

void SumCheck::add_lights(const RawExr& file) {
    Sum sum{ExrRule::sum_of_lights, "", {}, {}, 0, 0};
    std::set<std::string> layers;
    for (const RawPart& part : file.parts)
        for (const RawChannel& c : part.channels) layers.insert(c.layer());
    for (const std::string& layer : layers) {
        if (!layer.starts_with("RGBA_")) continue;
        const auto set = find_channels(file, layer, "RGB");
        if (!set) continue;
        sum.terms.push_back(*set);
        sum.names += (sum.names.empty() ? "" : " + ") + layer;
    }
    if (sum.terms.size() > 1) sums_.push_back(std::move(sum));
}

void SumCheck::look(const ExrStripView& strip, Sum& sum) const {
    for (const ChannelSet& s : sum.terms)
        if (strip.planes[s.part].empty()) return;
    for (std::size_t i = 0; i < strip.pixels(); ++i) {
        bool off = false;
        for (std::size_t c = 0; c < 3; ++c) {
            const float beauty = strip.planes[beauty_->part][beauty_->channels[c]][i];
            float total = 0, size = std::abs(beauty);
            for (const ChannelSet& s : sum.terms) {
                const float v = strip.planes[s.part][s.channels[c]][i];
                total += v, size += std::abs(v);
            }
            const float difference = std::abs(total - beauty);
            if (!std::isfinite(difference) || difference <= kRelative * size + kAbsolute) continue;
            off = true;
            sum.worst = std::max(sum.worst, difference / size);
        }
        if (off) sum.tally.add(strip, i);
    }
    sum.pixels += strip.pixels();
}

void SumCheck::look(const ExrStripView& strip) {
    if (!beauty_ || strip.planes[beauty_->part].empty()) return;
    for (Sum& sum : sums_) look(strip, sum);
}

void SumCheck::tell(ExrFindings& out) const {
    for (const Sum& sum : sums_) {
        if (sum.tally.count == 0) continue;
        out.push_back(
            {sum.rule, sum.names,
             fmt::format("{} of {}; the worst is off by {:.2g} of what is added",
                         to_string(sum.tally), sum.pixels, static_cast<double>(sum.worst))});
    }
}

}  // namespace tessera
