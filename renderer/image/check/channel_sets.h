#pragma once
// Where a layer's channels are.

#include <optional>
#include <string>
#include <vector>

#include "renderer/image/check/exr_raw.h"

namespace tessera {

struct ChannelSet {
    std::size_t part = 0;
    std::vector<std::size_t> channels;  // in the order asked for
};

/// The channels "layer.T" for each letter T of tokens ("" = root), all in one part.
std::optional<ChannelSet> find_channels(const RawExr& file, const std::string& layer,
                                        const std::string& tokens);

}  // namespace tessera
