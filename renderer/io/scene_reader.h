#pragma once
// What the parts of the scene file's reader share. Private to the reader: use load_scene.

#include <map>
#include <set>
#include <string>

#include "renderer/io/assets.h"
#include "renderer/io/params.h"

namespace tessera {

class ShapeNames;

/// Where the reading of one scene stands.
struct SceneReader {
    SceneDesc& scene;
    Problems& problems;
    const AssetRules& assets;
    std::string folder;                                      // of the scene file
    std::map<std::string, int, std::less<>> materials = {};  // name -> scene.materials
    std::map<std::string, int, std::less<>> textures =
        {};                              // all that makes a texture -> scene.textures
    std::set<std::string> ignored = {};  // keys reported as not supported yet
    std::map<std::string, MaterialDesc, std::less<>> materialx = {};  // of MaterialX documents

    /// The folder that names written at loc are relative to.
    std::string folder_of(const SourceLoc& loc) const;
    AssetPath find(const std::string& name, const SourceLoc& loc) const;
    /// Records that a file was read, once.
    void add_file(const std::string& path);
    /// The index of an equal texture, appended when new.
    int add_texture(TextureDesc texture);
    /// The index of a material by name; -1 for "" and, reported, for a name that nothing has.
    int material(const std::string& name, const SourceLoc& loc, const ReadContext& at);
    /// 'default', made when nothing of that name is there: for shapes without a material.
    int default_material();
};

/// "light 'key'" by name, else "light 3" by its place in the file.
std::string subject_of(const std::string& kind, const Value& table, std::size_t index);

// Each part reads its tables of the document, and lists their keys for the root table.
void read_settings(const Value& document,
                   SceneReader& reader);  // camera, film, output, render, environment
void read_output(const Value& table, SceneReader& reader);
void load_meshes(const Value& document, SceneReader& reader,
                 ShapeNames& names);  // the files of [[mesh]]
void read_materials(const Value& document,
                    SceneReader& reader);  // after load_meshes: may replace its own
void read_shapes(const Value& document, SceneReader& reader, ShapeNames& names);  // all but meshes
void read_lights(const Value& document, SceneReader& reader);

const KeyList& camera_keys();
const KeyList& film_keys();
const KeyList& output_keys();
const KeyList& render_keys();
const KeyList& environment_keys();
const KeyList& sky_keys();
const KeyList& material_keys();
const KeyList& mesh_keys();
const KeyList& sphere_keys();
const KeyList& disc_keys();
const KeyList& group_keys();
const KeyList& instance_keys();
std::vector<const KeyList*> light_keys();  // one for each type

}  // namespace tessera
