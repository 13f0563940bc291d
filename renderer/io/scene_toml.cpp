#include "renderer/io/scene_toml.h"

#include <algorithm>

#include "renderer/io/mtlx.h"
#include "renderer/io/scene_shapes.h"

namespace tessera {
namespace {

struct Root {
    int version = 0;
    std::vector<std::string> include, materialx;
};

/// A row for a table that a part of the reader reads by itself.
Key table_row(const std::string& name, Form::Kind kind, std::vector<const KeyList*> tables,
              const std::string& help) {
    const auto store = [](void*, const Value&, const Key&, const ReadContext&) {};
    return {name, Form{.kind = kind, .tables = std::move(tables)}, help, store};
}

const KeySet<Root>& root_rows() {
    using Kind = Form::Kind;
    static const KeySet<Root> keys{
        {"scene",
         {
             key("tessera", &Root::version, "Version of the format: 1.", {.low = 1, .high = 1})
                 .must(),
             key("include", &Root::include, "Scene files whose tables are read before this one's."),
             table_row("camera", Kind::table, {&camera_keys()},
                       "The camera; absent, it frames the scene by itself."),
             table_row("film", Kind::table, {&film_keys()}, "The picture."),
             table_row("output", Kind::table, {&output_keys()}, "The file it is written to."),
             table_row("render", Kind::table, {&render_keys()}, "How it is made."),
             table_row("environment", Kind::table, {&environment_keys()}, "Light from all around."),
             table_row("sky", Kind::table, {&sky_keys()}, "A clear sky with its sun."),
             table_row("mesh", Kind::tables, {&mesh_keys()}, "A mesh from an OBJ file."),
             table_row("sphere", Kind::tables, {&sphere_keys()}, "An exact sphere."),
             table_row("disc", Kind::tables, {&disc_keys()}, "An exact disc."),
             table_row("group", Kind::tables, {&group_keys()}, "Shapes to be placed together."),
             table_row("instance", Kind::tables, {&instance_keys()},
                       "A shape or group, placed once or many times."),
             table_row("light", Kind::tables, light_keys(), "A light."),
             table_row("material", Kind::named_tables, {&material_keys()}, "OpenPBR Surface."),
             key("materialx", &Root::materialx,
                 "MaterialX documents whose materials the scene may name."),
         }}};
    return keys;
}

bool emits(const MaterialDesc& material) {
    const ColorInput& color = material.emission_color;
    const bool some_color =
        std::any_of(color.value.begin(), color.value.end(), [](float c) { return c > 0; });
    return material.emission_luminance.value > 0 && some_color;
}

std::vector<bool> materials_in_use(const SceneDesc& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    const auto use = [&](int material) {
        if (material >= 0 && static_cast<std::size_t>(material) < used.size())
            used[material] = true;
    };
    for (const MeshDesc& mesh : scene.meshes)
        std::for_each(mesh.materials.begin(), mesh.materials.end(), use);
    for (const SphereDesc& sphere : scene.spheres) use(sphere.material);
    for (const DiscDesc& disc : scene.discs) use(disc.material);
    for (const InstanceDesc& instance : scene.instances) use(instance.material);
    for (const GroupDesc& group : scene.groups) {
        for (const InstanceDesc& member : group.members) use(member.material);
    }
    return used;
}

}  // namespace

const KeyList& scene_keys() { return root_rows().list; }

bool has_emitter(const SceneDesc& scene, bool textured) {
    if (scene.environment || scene.sky || !scene.lights.empty()) return true;
    const std::vector<bool> used = materials_in_use(scene);
    for (std::size_t m = 0; m < used.size(); ++m) {
        const MaterialDesc& material = scene.materials[m];
        const bool by_texture =
            material.emission_color.texture >= 0 || material.emission_luminance.texture >= 0;
        if (used[m] && emits(material) && (textured || !by_texture)) return true;
    }
    return false;
}

SceneDesc read_scene(Value document, const std::string& path, const std::string& folder,
                     const AssetRules& assets, Problems& problems) {
    Table& tables = std::get<Table>(document.data);
    if (!tables.contains("tessera")) {
        problems.error(document.loc,
                       "'tessera = 1' is missing: the version of the format, it stands first");
        tables.emplace("tessera", Value{std::int64_t(1), document.loc});
    }
    Root root;
    read_keys(document, root_rows(), root, {problems, "", "table"});
    SceneDesc scene;
    scene.path = path;
    SceneReader reader{scene, problems, assets, folder};
    ShapeNames names;
    read_settings(document, reader);
    read_materialx(document, reader);
    load_meshes(document, reader, names);
    place_materialx(reader);
    read_materials(document, reader);
    read_shapes(document, reader, names);
    read_lights(document, reader);
    problems.throw_if_any();
    return scene;
}

}  // namespace tessera
