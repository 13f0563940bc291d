#include "renderer/image/check/check_values.h"

#include <cmath>
#include <set>

#include <fmt/format.h>

#include "renderer/image/check/channel_sets.h"
#include "renderer/image/check/check_header.h"
#include "renderer/image/pass_names.h"

namespace tessera {
namespace {

constexpr float kHalfMax = 65504;
// Halves near 1 are 2^-11 apart, and filters sum their weights to 1 within a few of those.
constexpr float kAlphaSlack = 2e-3f;
constexpr float kNormalSlack = 0.02f;

std::string last_word(const std::string& layer) { return layer.substr(layer.rfind('.') + 1); }

bool is_colour_token(const std::string& t) { return t == "R" || t == "G" || t == "B"; }

// A file of one pass says in its header which.
std::string name_of(const RawPart& part, const RawChannel& channel) {
    const std::string layer = channel.layer();
    if (!layer.empty()) return last_word(layer);
    return channel.token() == "Z" ? "depth" : part.text("tessera/pass");
}

bool is_normals(const std::string& name) {
    return name == "N" || name == "Ng" || name == "Ns" || name == "Normal" || name == "normal" ||
           name == "normals";
}

}  // namespace

std::string to_string(const Tally& t) {
    return t.count == 1 ? fmt::format("1 pixel, at {},{}", t.x, t.y)
                        : fmt::format("{} pixels, the first at {},{}", t.count, t.x, t.y);
}

ValueCheck::ValueCheck(const RawExr& file) : file_(file) {
    std::set<std::string> layers;
    for (std::size_t p = 0; p < file.parts.size(); ++p) {
        for (std::size_t c = 0; c < file.parts[p].channels.size(); ++c) {
            const RawChannel& channel = file.parts[p].channels[c];
            const std::string layer = channel.layer(), token = channel.token();
            const std::string name = name_of(file.parts[p], channel);
            layers.insert(layer);
            if (is_cryptomatte_pass(name)) continue;
            const bool data = is_data_pass(name);
            // A lone A is some value of its own: many renderers end one-channel layers so.
            const bool coverage =
                token == "A" && !data &&
                (find_channels(file, layer, "RA") || find_channels(file, layer, "YA"));
            ChannelState state{p, c, is_colour_token(token) && !data, coverage, false, {}};
            state.depth =
                token == "Z" && (name == "depth" || name == "Z" || name == "depth_filtered");
            channels_.push_back(state);
        }
    }
    for (const std::string& layer : layers) {
        if (is_normals(layer.empty() ? file.parts[0].text("tessera/pass") : last_word(layer))) {
            auto set = find_channels(file, layer, "XYZ");
            if (!set) set = find_channels(file, layer, "RGB");
            if (set)
                normals_.push_back({layer,
                                    set->part,
                                    {set->channels[0], set->channels[1], set->channels[2]},
                                    0,
                                    {},
                                    {}});
        }
    }
    if (const auto set = find_channels(file, "", "RGBA"))
        beauties_.push_back(
            {set->part,
             {set->channels[0], set->channels[1], set->channels[2], set->channels[3]},
             {}});
}

void ValueCheck::look(const ExrStripView& strip, ChannelState& s) const {
    if (strip.planes[s.part].empty()) return;
    const std::vector<float>& plane = strip.planes[s.part][s.channel];
    const bool half = file_.parts[s.part].channels[s.channel].type == ExrType::half;
    const bool lossy = file_.parts[s.part].lossy();  // makes small negative values of its own
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const float v = plane[i];
        if (std::isnan(v)) s.tally[nan].add(strip, i);
        if (std::isinf(v)) s.tally[infinite].add(strip, i);
        if (s.colour && v < 0 && !lossy) s.tally[negative].add(strip, i);
        if (half && std::abs(v) == kHalfMax) s.tally[limit].add(strip, i);
        if (s.alpha && (v < -kAlphaSlack || v > 1 + kAlphaSlack)) s.tally[alpha].add(strip, i);
    }
}

void ValueCheck::look(const ExrStripView& strip, BeautyState& s) {
    if (strip.planes[s.part].empty()) return;
    const auto& planes = strip.planes[s.part];
    for (std::size_t i = 0; i < strip.pixels(); ++i) {
        const bool lit = planes[s.channel[0]][i] > 0 || planes[s.channel[1]][i] > 0 ||
                         planes[s.channel[2]][i] > 0;
        if (lit && planes[s.channel[3]][i] == 0) s.tally.add(strip, i);
    }
}

void ValueCheck::look(const ExrStripView& strip, NormalState& s) {
    if (strip.planes[s.part].empty()) return;
    const auto& planes = strip.planes[s.part];
    for (std::size_t i = 0; i < strip.pixels(); ++i) {
        const float x = planes[s.channel[0]][i], y = planes[s.channel[1]][i],
                    z = planes[s.channel[2]][i];
        const float length = std::sqrt(x * x + y * y + z * z);
        if (length == 0) continue;
        ++s.normals;
        if (length > 1 + kNormalSlack) s.too_long.add(strip, i);
        if (!(std::abs(length - 1) <= kNormalSlack)) s.odd.add(strip, i);
    }
}

void ValueCheck::look(const ExrStripView& strip) {
    for (ChannelState& s : channels_) look(strip, s);
    for (BeautyState& s : beauties_) look(strip, s);
    for (NormalState& s : normals_) look(strip, s);
}

void ValueCheck::tell(ExrFindings& out) const {
    const auto say = [&](ExrRule rule, const std::string& where, const Tally& tally) {
        if (tally.count > 0) out.push_back({rule, where, to_string(tally)});
    };
    for (const ChannelState& s : channels_) {
        const RawPart& part = file_.parts[s.part];
        const std::string where = where_channel(part.channels[s.channel]);
        say(ExrRule::nan, where, s.tally[nan]);
        say(s.depth ? ExrRule::infinite_depth : ExrRule::infinite, where, s.tally[infinite]);
        if (part.lossy()) say(ExrRule::infinite_lossy, where, s.tally[infinite]);
        say(ExrRule::negative_colour, where, s.tally[negative]);
        say(ExrRule::half_limit, where, s.tally[limit]);
        say(ExrRule::alpha_range, where, s.tally[alpha]);
    }
    for (const BeautyState& s : beauties_) say(ExrRule::light_without_alpha, "beauty", s.tally);
    for (const NormalState& s : normals_) {
        const bool most_odd = s.odd.count * 2 > s.normals;
        say(ExrRule::normal_length, "layer '" + s.layer + "'", most_odd ? s.odd : s.too_long);
    }
}

}  // namespace tessera
