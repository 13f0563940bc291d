#include "renderer/io/scene_textures.h"

#include "renderer/io/texture_files.h"

namespace tessera {
namespace {

using T = TextureEntry;
constexpr double kMostFrames = 1e6;

std::vector<Key> placement_rows() {
    return {
        key("file", &T::file,
            "The image. In its name: '####', '%04d' or '<frame>' for the frame, '<UDIM>' or "
            "'<UVTILE>' for tiles.")
            .must(),
        uniform_key("scale", &T::scale,
                    "uv * scale + offset is looked up: 4 repeats the image 4 times."),
        key("offset", &T::offset, "Added to uv after scale."),
        choice("wrap", &T::wrap, {"repeat", "clamp", "mirror", "black"},
               "What lies outside the image."),
        choice("filter", &T::filter, {"trilinear", "closest", "bilinear", "bicubic", "stochastic"},
               "How texels become a value; closest and bilinear read the finest level only."),
        key("frame_offset", &T::frame_offset,
            "Added to [render] frame where the file's name counts frames.",
            {.low = -kMostFrames, .high = kMostFrames}),
    };
}

std::vector<Key> value_rows() {
    std::vector<Key> rows = placement_rows();
    rows.push_back(key("color_space", &T::color_space,
                       "Colour space; absent: sRGB for colours, raw for scalars."));
    rows.push_back(key("gain", &T::gain, "Factor on the image, before bias."));
    rows.push_back(key("bias", &T::bias, "Added to the image after gain."));
    return rows;
}

}  // namespace

const KeySet<TextureEntry>& color_texture_keys() {
    static const KeySet<T> keys = [] {
        KeySet<T> rows{{"image for a colour", value_rows()}};
        rows.list.keys.push_back(
            key("factor", &T::tint, "Number or colour the image is multiplied by.", kAtLeast0));
        return rows;
    }();
    return keys;
}

const KeySet<TextureEntry>& scalar_texture_keys() {
    static const KeySet<T> keys = [] {
        KeySet<T> rows{{"image for a scalar", value_rows()}};
        std::vector<Key>& list = rows.list.keys;
        Key channel =
            choice("channel", &T::channel, {"automatic", "r", "g", "b", "a", "luminance"},
                   "The channel that is read; automatic: a for opacity if there is one, else r.");
        list.push_back(std::move(channel));
        list.push_back(key("invert", &T::invert, "1 - image, before factor."));
        list.push_back(key("factor", &T::factor, "Factor on the image.", kAtLeast0));
        return rows;
    }();
    return keys;
}

const KeySet<TextureEntry>& normal_texture_keys() {
    static const KeySet<T> keys = [] {
        KeySet<T> rows{{"normal map", placement_rows()}};
        rows.list.keys.push_back(
            key("scale_normal", &T::scale_normal, "Strength of the bumps.", kAtLeast0));
        rows.list.keys.push_back(choice("convention", &T::convention, {"opengl", "directx"},
                                        "Where the map's green points: up or down."));
        return rows;
    }();
    return keys;
}

int add_texture(const Value& table, const TextureEntry& entry, const ReadContext& at,
                SceneReader& reader) {
    const Value* written = table.find("file");
    if (entry.file.empty()) {
        if (written && written->text())
            at.problems.error(written->loc, at.subject + ": file is empty");
        return -1;  // else reported as missing
    }
    const SourceLoc loc = written ? written->loc : table.loc;
    const TextureFiles files = find_texture_files(reader.assets, entry.file, reader.folder_of(loc),
                                                  reader.scene.render.frame + entry.frame_offset);
    const AssetPath& found = files.found;
    if (found.refused) {
        at.problems.error(loc, at.subject + ": texture '" + entry.file + "' " + found.reason);
        return -1;
    }
    if (!found.note.empty()) at.problems.note(loc, at.subject + ": texture " + found.note);
    if (!files.missing.empty())
        at.problems.damage(loc, at.subject + ": texture '" + files.name + "' " + files.missing);
    TextureDesc texture;
    texture.file = found.path.empty() ? reader.folder_of(loc) + "/" + files.name : found.path;
    texture.tiles = files.tiles;
    texture.color_space = entry.color_space;
    texture.wrap_u = entry.wrap;
    texture.wrap_v = entry.wrap_v.value_or(entry.wrap);
    texture.filter = entry.filter;
    texture.scale = entry.scale;
    texture.offset = entry.offset;
    texture.gain = entry.gain;
    texture.bias = entry.bias;
    texture.loc = loc;
    return reader.add_texture(std::move(texture));
}

}  // namespace tessera
