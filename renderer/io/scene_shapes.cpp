#include "renderer/io/scene_shapes.h"

#include <cmath>
#include <filesystem>

#include "renderer/io/obj.h"
#include "renderer/io/scene_subdivision.h"

namespace tessera {
namespace {

struct MeshEntry {
    CommonEntry common;
    std::string file;
    SubdivisionDesc subdivision;
};

struct SphereEntry {
    CommonEntry common;
    SphereDesc sphere;
};

struct DiscEntry {
    CommonEntry common;
    DiscDesc disc;
};

const KeySet<MeshEntry>& mesh_rows() {
    static const auto keys = [] {
        auto rows = rows_with_common<MeshEntry>(
            "mesh", {key("file", &MeshEntry::file,
                         "An OBJ file; without a name the mesh is called after it.")
                         .must()});
        add_part(rows, subdivision_rows(), &MeshEntry::subdivision);
        return rows;
    }();
    return keys;
}

const KeySet<SphereEntry>& sphere_rows() {
    static const auto keys = [] {
        KeySet<SphereDesc> own{{"sphere",
                                {
                                    key("center", &SphereDesc::center, "Its middle."),
                                    key("radius", &SphereDesc::radius, "Its radius.", kAbove0),
                                }}};
        KeySet<SphereEntry> rows{{"sphere", {}}};
        add_part(rows, own, &SphereEntry::sphere);
        add_part(rows, common_rows(), &SphereEntry::common);
        return rows;
    }();
    return keys;
}

const KeySet<DiscEntry>& disc_rows() {
    static const auto keys = [] {
        KeySet<DiscDesc> own{
            {"disc",
             {
                 key("center", &DiscDesc::center, "Its middle."),
                 key("normal", &DiscDesc::normal, "The way its front looks; any length."),
                 key("radius", &DiscDesc::radius, "Its radius.", kAbove0),
             }}};
        KeySet<DiscEntry> rows{{"disc", {}}};
        add_part(rows, own, &DiscEntry::disc);
        add_part(rows, common_rows(), &DiscEntry::common);
        return rows;
    }();
    return keys;
}

class MeshLoader {
public:
    MeshLoader(const Value& document, SceneReader& reader) : reader_(reader) {
        for (const auto& [name, material] : reader.materialx) defined_.insert(name);
        const Value* materials = document.find("material");
        if (!materials || !materials->table()) return;
        for (const auto& [name, table] : *materials->table()) {
            // One that inherits from itself changes what a library has to define.
            const Value* parent = table.table() ? table.find("inherits") : nullptr;
            if (!parent || !parent->text() || *parent->text() != name) defined_.insert(name);
        }
    }

    /// The mesh of a file, loaded once however many [[mesh]] name it, and kept once for those who
    /// have it subdivided alike; -1 after reporting.
    int load(const std::string& file, const SubdivisionDesc& subdivision, const SourceLoc& loc,
             const ReadContext& at) {
        const AssetPath found = reader_.find(file, loc);
        if (!found.note.empty()) at.problems.note(loc, at.subject + ": " + found.note);
        if (found.path.empty()) {
            at.problems.error(loc, at.subject + ": file '" + file + "' " + found.reason);
            return -1;
        }
        const auto [entry, is_new] = loaded_.try_emplace(found.path);
        std::vector<int>& forms = entry->second;
        std::vector<MeshDesc>& meshes = reader_.scene.meshes;
        if (is_new) {
            const int index = load_new(found.path, loc, at);
            if (index < 0) return -1;
            meshes[static_cast<std::size_t>(index)].subdivision = subdivision;
            forms.push_back(index);
        }
        if (forms.empty()) return -1;
        for (const int index : forms)
            if (alike(meshes[static_cast<std::size_t>(index)].subdivision, subdivision))
                return index;
        MeshDesc other = meshes[static_cast<std::size_t>(forms.front())];
        other.subdivision = subdivision;
        forms.push_back(static_cast<int>(meshes.size()));
        meshes.push_back(std::move(other));
        return forms.back();
    }

private:
    int load_new(const std::string& path, const SourceLoc& loc, const ReadContext& at) {
        try {
            return load_obj(path, reader_.assets, reader_.scene, at.problems, {loc, defined_});
        } catch (const Error& error) {
            const bool full = at.problems.errors().size() >= std::size_t(Problems::kMax);
            if (full || error.code() != ExitCode::scene) throw;
            at.problems.error({}, error.what());
            return -1;
        }
    }

    SceneReader& reader_;
    std::set<std::string> defined_;                   // materials of the scene file
    std::map<std::string, std::vector<int>> loaded_;  // path -> its meshes, by subdivision
};

void read_spheres(const Value& document, SceneReader& reader, ShapeNames& names) {
    for (const Value& table : tables_of(document, "sphere", reader.problems)) {
        std::vector<SphereDesc>& all = reader.scene.spheres;
        const ReadContext at{reader.problems, subject_of("sphere", table, all.size())};
        SphereEntry entry;
        read_keys(table, sphere_rows(), entry, at);
        const int material = reader.material(entry.common.material, material_loc(table), at);
        entry.sphere.name = entry.common.name;
        entry.sphere.loc = table.loc;
        entry.sphere.material = material >= 0 ? material : reader.default_material();
        entry.common.material.clear();  // it is the sphere's own, not a replacement
        add_named(table, entry.common, {ShapeKind::sphere, static_cast<int>(all.size())}, true, at,
                  names);
        all.push_back(entry.sphere);
    }
}

void read_discs(const Value& document, SceneReader& reader, ShapeNames& names) {
    for (const Value& table : tables_of(document, "disc", reader.problems)) {
        std::vector<DiscDesc>& all = reader.scene.discs;
        const ReadContext at{reader.problems, subject_of("disc", table, all.size())};
        DiscEntry entry;
        read_keys(table, disc_rows(), entry, at);
        const Double3& n = entry.disc.normal;
        if (!(std::hypot(n[0], n[1], n[2]) > 1e-30)) {
            at.problems.error(table.find("normal")->loc, at.subject + ": normal has no direction");
        }
        const int material = reader.material(entry.common.material, material_loc(table), at);
        entry.disc.name = entry.common.name;
        entry.disc.loc = table.loc;
        entry.disc.material = material >= 0 ? material : reader.default_material();
        entry.common.material.clear();
        add_named(table, entry.common, {ShapeKind::disc, static_cast<int>(all.size())}, true, at,
                  names);
        all.push_back(entry.disc);
    }
}

}  // namespace

void load_meshes(const Value& document, SceneReader& reader, ShapeNames& names) {
    MeshLoader loader(document, reader);
    std::size_t number = 0;
    for (const Value& table : tables_of(document, "mesh", reader.problems)) {
        const ReadContext at{reader.problems, subject_of("mesh", table, number++)};
        MeshEntry entry;
        read_keys(table, mesh_rows(), entry, at);
        const bool named = !entry.common.name.empty();
        if (!named) entry.common.name = std::filesystem::path(entry.file).stem().string();
        check_subdivision(table, entry.subdivision, at);
        int index = -1;
        if (!entry.file.empty())
            index = loader.load(entry.file, entry.subdivision, table.find("file")->loc, at);
        if (index >= 0 && entry.subdivision.scheme != Subdivision::none)
            reader.scene.meshes[static_cast<std::size_t>(index)].name = entry.common.name;
        add_named(table, entry.common, {ShapeKind::mesh, index}, named, at, names);
    }
}

void read_shapes(const Value& document, SceneReader& reader, ShapeNames& names) {
    for (const NamedShape& mesh : names.all()) {
        const ReadContext at{reader.problems, "mesh '" + mesh.name + "'"};
        reader.material(mesh.material, mesh.material_loc, at);
    }
    read_spheres(document, reader, names);
    read_discs(document, reader, names);
    read_groups(document, reader, names);
    read_instances(document, reader, names);
    check_groups(reader.scene, reader.problems);
}

const KeyList& mesh_keys() { return mesh_rows().list; }
const KeyList& sphere_keys() { return sphere_rows().list; }
const KeyList& disc_keys() { return disc_rows().list; }

}  // namespace tessera
