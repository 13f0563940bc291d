#pragma once
// Images as inputs of a material: { file = "tiles.png", scale = 4 }. Private to the scene reader.

#include <optional>
#include <string>

#include "renderer/io/scene_reader.h"

namespace tessera {

/// Which way green points in a normal map.
enum class NormalConvention : std::uint8_t { opengl, directx };

/// An image table as it is written.
struct TextureEntry {
    std::string file;
    Float2 scale{1, 1};
    Float2 offset{0, 0};
    Wrap wrap = Wrap::repeat;
    std::optional<Wrap> wrap_v = {};  // along v, where it differs
    std::string color_space;
    float gain = 1;
    float bias = 0;
    Float3 tint{1, 1, 1};  // 'factor' of a colour
    float factor = 1;      // 'factor' of a scalar
    Channel channel = Channel::automatic;
    bool invert = false;
    float scale_normal = 1;
    NormalConvention convention = NormalConvention::opengl;
};

const KeySet<TextureEntry>& color_texture_keys();
const KeySet<TextureEntry>& scalar_texture_keys();
const KeySet<TextureEntry>& normal_texture_keys();

/// The texture's index, -1 for an entry without a file name or, reported, for one outside the
/// scene's folders. A file that is not there keeps its name, for the texture store to report and to
/// show in magenta.
int add_texture(const Value& table, const TextureEntry& entry, const ReadContext& at,
                SceneReader& reader);

}  // namespace tessera
