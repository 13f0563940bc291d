#pragma once
// What the name of a texture stands for: one file, one frame of a sequence, or a set of tiles.
//
// Frames: "####" (padded to as many digits), "%04d", "<frame>" and "<F>" (not padded), "<F4>".
// Tiles: "<UDIM>" (1001 + column + 10 row), "<UVTILE>" ("u1_v1": column + 1, row + 1). A file whose
// name is literally what is written comes first.

#include <string>
#include <vector>

#include "renderer/api/scene_desc.h"
#include "renderer/io/assets.h"

namespace tessera {

struct TextureFiles {
    AssetPath found;   // as of AssetRules::find; path is a set's pattern when there are tiles
    std::string name;  // as written, the frame put in
    std::vector<TextureTile> tiles;
    std::string missing;  // of a sequence or set: what was looked for; empty: all is well
};

/// name as written in a file in base_dir; `frame` is the sequence's own, its offset added.
TextureFiles find_texture_files(const AssetRules& assets, const std::string& name,
                                const std::string& base_dir, int frame);

/// "1-4, 7" of sorted numbers.
std::string ranges_of(const std::vector<int>& numbers);

}  // namespace tessera
