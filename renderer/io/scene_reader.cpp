#include "renderer/io/scene_reader.h"

#include <algorithm>

#include "renderer/core/nearest_name.h"
#include "renderer/io/scene_document.h"

namespace tessera {

std::string SceneReader::folder_of(const SourceLoc& loc) const {
    return tessera::folder_of(loc, folder);
}

AssetPath SceneReader::find(const std::string& name, const SourceLoc& loc) const {
    return assets.find(name, folder_of(loc));
}

void SceneReader::add_file(const std::string& path) {
    std::vector<std::string>& files = scene.files;
    if (std::find(files.begin(), files.end(), path) == files.end()) files.push_back(path);
}

int SceneReader::add_texture(TextureDesc texture) {
    std::string identity = texture.file + '\n' + texture.color_space;
    for (const double number :
         {double(texture.wrap_u), double(texture.wrap_v), double(texture.scale[0]),
          double(texture.scale[1]), double(texture.offset[0]), double(texture.offset[1]),
          double(texture.gain), double(texture.bias), double(texture.filter)}) {
        identity += '\n' + number_text(number);
    }
    const auto [entry, is_new] =
        textures.emplace(identity, static_cast<int>(scene.textures.size()));
    if (is_new) scene.textures.push_back(std::move(texture));
    return entry->second;
}

int SceneReader::material(const std::string& name, const SourceLoc& loc, const ReadContext& at) {
    if (name.empty()) return -1;
    const auto found = materials.find(name);
    if (found != materials.end()) return found->second;
    std::vector<std::string> names;
    for (const auto& [known, index] : materials) names.push_back(known);
    problems.error(
        loc, at.subject + ": there is no material '" + name + "'" + did_you_mean(name, names));
    return -1;
}

int SceneReader::default_material() {
    const auto [entry, is_new] =
        materials.emplace("default", static_cast<int>(scene.materials.size()));
    if (is_new) scene.materials.emplace_back().name = "default";
    return entry->second;
}

std::string subject_of(const std::string& kind, const Value& table, std::size_t index) {
    const Value* name = table.find("name");
    if (name && name->text()) return kind + " '" + *name->text() + "'";
    return kind + "[" + std::to_string(index) + "]";  // as --set names it
}

}  // namespace tessera
