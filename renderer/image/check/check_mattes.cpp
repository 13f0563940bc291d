#include "renderer/image/check/check_mattes.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "renderer/image/check/matte_header.h"
#include "renderer/image/pass_names.h"

namespace tessera {
namespace {

constexpr float kSlack = 1e-3f;  // weights summed in float
constexpr int kMaxRanks = 100;

bool is_rank(const std::string& layer, const std::string& name) {
    return layer.size() == name.size() + 2 && layer.starts_with(name) &&
           std::all_of(layer.end() - 2, layer.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::set<std::string> layers_of(const RawExr& file) {
    std::set<std::string> layers;
    for (const RawPart& part : file.parts)
        for (const RawChannel& c : part.channels) layers.insert(c.layer());
    return layers;
}

// The specification allows lower-case letters too.
std::optional<ChannelSet> find_rank(const RawExr& file, const std::string& layer) {
    const auto set = find_channels(file, layer, "RGBA");
    return set ? set : find_channels(file, layer, "rgba");
}

}  // namespace

MatteCheck::MatteCheck(const RawExr& file, ExrFindings& out) {
    const std::set<std::string> layers = layers_of(file);
    std::set<std::string> told;
    for (MatteHeader& header : read_matte_headers(file, out)) {
        if (header.name.empty()) continue;
        Matte matte{header.name, {}, std::move(header.ids), header.named, {}, {}};
        for (int rank = 0; rank < kMaxRanks; ++rank) {
            const auto set = find_rank(file, fmt::format("{}{:02}", header.name, rank));
            if (!set) break;
            matte.ranks.push_back(*set);
        }
        const auto there = static_cast<std::size_t>(
            std::count_if(layers.begin(), layers.end(),
                          [&](const std::string& l) { return is_rank(l, header.name); }));
        if (matte.ranks.empty() || matte.ranks.size() != there)
            out.push_back(
                {ExrRule::matte_layers, "cryptomatte '" + header.name + "'",
                 fmt::format("{} of {} layers of ranks can be used", matte.ranks.size(), there)});
        told.insert(header.name);
        mattes_.push_back(std::move(matte));
    }
    for (const std::string& layer : layers) {
        const bool known = std::any_of(told.begin(), told.end(), [&](const std::string& name) {
            return layer == name || is_rank(layer, name);
        });
        if (is_cryptomatte_pass(layer) && !known)
            out.push_back({ExrRule::matte_layers, "layer '" + layer + "'",
                           "nothing in the header belongs to it"});
    }
}

void MatteCheck::look(const ExrStripView& strip, Matte& matte) {
    for (const ChannelSet& rank : matte.ranks)
        if (strip.planes[rank.part].empty()) return;
    for (std::size_t i = 0; i < strip.pixels(); ++i) {
        float sum = 0;
        bool negative = false, unknown = false;
        for (const ChannelSet& rank : matte.ranks) {
            const auto& planes = strip.planes[rank.part];
            for (std::size_t pair = 0; pair < 4; pair += 2) {
                const float id = planes[rank.channels[pair]][i];
                const float coverage = planes[rank.channels[pair + 1]][i];
                sum += coverage;
                negative = negative || coverage < 0;
                unknown = unknown || (id != 0 && coverage > 0 &&
                                      !matte.ids.contains(std::bit_cast<std::uint32_t>(id)));
            }
        }
        if (negative || !(sum <= 1 + kSlack)) matte.coverage.add(strip, i);
        if (unknown && matte.named) matte.unknown.add(strip, i);
    }
}

void MatteCheck::look(const ExrStripView& strip) {
    for (Matte& matte : mattes_) look(strip, matte);
}

void MatteCheck::tell(ExrFindings& out) const {
    for (const Matte& m : mattes_) {
        const std::string where = "cryptomatte '" + m.name + "'";
        if (m.coverage.count > 0)
            out.push_back({ExrRule::matte_coverage, where, to_string(m.coverage)});
        if (m.unknown.count > 0) out.push_back({ExrRule::matte_ids, where, to_string(m.unknown)});
    }
}

}  // namespace tessera
