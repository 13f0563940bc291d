#include "renderer/image/check/channel_sets.h"

#include <algorithm>

namespace tessera {

std::optional<ChannelSet> find_channels(const RawExr& file, const std::string& layer,
                                        const std::string& tokens) {
    for (std::size_t p = 0; p < file.parts.size(); ++p) {
        const std::vector<RawChannel>& all = file.parts[p].channels;
        ChannelSet set{p, {}};
        for (const char token : tokens) {
            const auto found = std::find_if(all.begin(), all.end(), [&](const RawChannel& c) {
                return c.layer() == layer && c.token() == std::string(1, token);
            });
            if (found != all.end())
                set.channels.push_back(static_cast<std::size_t>(found - all.begin()));
        }
        if (set.channels.size() == tokens.size()) return set;
    }
    return std::nullopt;
}

}  // namespace tessera
