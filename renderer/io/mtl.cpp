#include "renderer/io/mtl.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "renderer/io/mtl_material.h"
#include "renderer/io/obj_text.h"
#include "renderer/io/texture_files.h"

namespace tessera {
namespace {

// A line of thousands of words is no list of libraries.
constexpr std::size_t kMostNames = 64;
constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;

// The names of a mtllib line, cut at blanks that no '\' stands before.
std::vector<std::string> split_names(const std::string& text) {
    std::vector<std::string> names(1);
    for (std::size_t i = 0; i < text.size() && names.size() <= kMostNames; ++i) {
        if (text[i] == '\\' && i + 1 < text.size() && is_blank(text[i + 1])) {
            names.back() += text[++i];
        } else if (!is_blank(text[i])) {
            names.back() += text[i];
        } else if (!names.back().empty()) {
            names.emplace_back();
        }
    }
    if (names.back().empty()) names.pop_back();
    return names;
}

std::string without_escapes(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] != '\\' || i + 1 == text.size() || !is_blank(text[i + 1])) out += text[i];
    return out;
}

std::string without_quotes(const std::string& text) {
    const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
}

std::string color_space_of(const std::string& option) {
    const std::string lower = to_lower(option);
    if (lower.empty() || lower == "srgb") return "";  // sRGB is the default for colours
    if (lower == "linear") return "lin_rec709";
    if (lower == "non-color" || lower == "raw") return "raw";
    return option;
}

using TextureKey = std::tuple<std::string, std::string, Wrap, Float2, Float2, float, float>;

TextureKey key_of(const TextureDesc& t) {
    return {t.file, t.color_space, t.wrap_u, t.scale, t.offset, t.gain, t.bias};
}

std::string folder_of(const std::string& path) {
    return std::filesystem::path(path).parent_path().string();
}

struct Library {
    std::string path, folder, text;
    std::unordered_map<std::string, MtlSection> sections;
    std::set<std::string, std::less<>> reported_keys;
    Tally tally;
};

}  // namespace

struct MtlLibraries::Impl {
    const AssetRules& assets;
    SceneDesc& scene;
    Problems& problems;
    std::vector<std::unique_ptr<Library>> libraries;
    std::set<std::string> lines_seen;
    std::map<TextureKey, int> textures;

    void load(const AssetPath& found, const std::string& obj_path, std::uint32_t line,
              Tally& obj_tally);
    int texture(const MtlTexture& texture, Library& library, std::uint32_t line);
};

MtlLibraries::MtlLibraries(const AssetRules& assets, SceneDesc& scene, Problems& problems)
    : impl_(std::make_unique<Impl>(Impl{assets, scene, problems, {}, {}, {}})) {
    for (std::size_t i = 0; i < scene.textures.size(); ++i)
        impl_->textures.try_emplace(key_of(scene.textures[i]), static_cast<int>(i));
}

MtlLibraries::~MtlLibraries() = default;

void MtlLibraries::Impl::load(const AssetPath& found, const std::string& obj_path,
                              std::uint32_t line, Tally& obj_tally) {
    const auto is_same = [&](const auto& library) { return library->path == found.path; };
    if (std::any_of(libraries.begin(), libraries.end(), is_same)) return;
    std::error_code error;
    if (std::filesystem::equivalent(found.path, obj_path, error))
        return obj_tally.add("mtllib names the OBJ itself, ignored", line);
    if (!found.note.empty()) obj_tally.note("mtllib", line, found.note);
    FileBytes file = read_regular_file(found.path, kMaxBytes);
    if (!file.error.empty())
        return obj_tally.add("mtllib cannot be read:", line, "'" + found.path + "': " + file.error);
    auto name = std::make_shared<const std::string>(found.path);
    libraries.push_back(std::make_unique<Library>(Library{found.path,
                                                          folder_of(found.path),
                                                          to_utf8(std::move(file.bytes)),
                                                          {},
                                                          {},
                                                          Tally(problems, name)}));
    Library& library = *libraries.back();
    library.sections = index_mtl(library.text, library.tally);
    scene.files.push_back(found.path);
}

void MtlLibraries::add(const std::string& names, const std::string& obj_path, std::uint32_t line,
                       Tally& obj_tally) {
    if (!impl_->lines_seen.insert(names).second) return;
    const std::string folder = folder_of(obj_path);
    const AssetPath whole = impl_->assets.find(without_quotes(without_escapes(names)), folder);
    if (!whole.path.empty()) return impl_->load(whole, obj_path, line, obj_tally);
    for (const std::string& name : split_names(names)) {
        const AssetPath found = impl_->assets.find(without_quotes(name), folder);
        if (!found.path.empty()) {
            impl_->load(found, obj_path, line, obj_tally);
        } else if (found.refused) {
            impl_->problems.error({obj_tally.file(), static_cast<int>(line), 0},
                                  "mtllib '" + name + "' " + found.reason);
        } else {
            obj_tally.add("mtllib", line, "'" + name + "' " + found.reason);
        }
    }
}

int MtlLibraries::Impl::texture(const MtlTexture& texture, Library& library, std::uint32_t line) {
    const SourceLoc loc{library.tally.file(), static_cast<int>(line), 0};
    const TextureFiles files =
        find_texture_files(assets, texture.file, library.folder, scene.render.frame);
    const AssetPath& found = files.found;
    if (found.refused) {
        problems.error(loc, "texture '" + texture.file + "' " + found.reason);
        return -1;
    }
    if (!found.note.empty())
        library.tally.note("texture", line, "'" + texture.file + "' " + found.note);
    if (!files.missing.empty())
        problems.damage(loc, "texture '" + files.name + "' " + files.missing);
    TextureDesc desc;
    // A missing one, or one that is no regular file, keeps its name, below the library's folder,
    // for the texture store to report.
    desc.file = found.path.empty() ? library.folder + "/" + files.name : found.path;
    desc.tiles = files.tiles;
    desc.color_space = color_space_of(texture.color_space);
    desc.wrap_u = desc.wrap_v = texture.clamp ? Wrap::clamp : Wrap::repeat;
    desc.scale = texture.scale;
    desc.offset = texture.offset;
    desc.gain = texture.gain;
    desc.bias = texture.base;
    desc.loc = loc;
    const auto [entry, added] =
        textures.try_emplace(key_of(desc), static_cast<int>(scene.textures.size()));
    if (added) scene.textures.push_back(std::move(desc));
    return entry->second;
}

int MtlLibraries::material(const std::string& name) {
    for (const auto& library : impl_->libraries) {
        const auto section = library->sections.find(name);
        if (section == library->sections.end()) continue;
        const MtlBlock block =
            normalise_mtl(library->text, section->second, library->tally, library->reported_keys);
        const MtlContext context{name, &block, &library->tally,
                                 [&](const MtlTexture& texture, std::uint32_t line) {
                                     return impl_->texture(texture, *library, line);
                                 }};
        MaterialDesc material = map_mtl(parse_mtl(block.text), context);
        material.loc = {library->tally.file(), static_cast<int>(section->second.line), 0};
        impl_->scene.materials.push_back(std::move(material));
        return static_cast<int>(impl_->scene.materials.size() - 1);
    }
    return -1;
}

void MtlLibraries::finish() {
    for (const auto& library : impl_->libraries) library->tally.finish();
}

}  // namespace tessera
