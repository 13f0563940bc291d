#pragma once
// OBJ scenes from strings, in a folder of their own that is removed at the end.

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "renderer/io/obj.h"
#include "tests/support/temp_folder.h"

namespace tessera::test {

class ObjFiles {
public:
    std::string path(const std::string& name) const { return folder_ / name; }

    void write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
        std::ofstream(path(name), std::ios::binary) << text;
    }

private:
    TempFolder folder_;
};

/// What loading gave: the mesh is empty and `error` set when it threw.
struct LoadedObj {
    SceneDesc scene;
    MeshDesc mesh;
    std::string error;
    std::vector<std::string> warnings, notes;

    bool warned(const std::string& text) const { return any(warnings, text); }
    bool noted(const std::string& text) const { return any(notes, text); }
    const MaterialDesc& material(std::size_t slot = 0) const {
        return scene.materials.at(static_cast<std::size_t>(mesh.materials.at(slot)));
    }

private:
    static bool any(const std::vector<std::string>& lines, const std::string& text) {
        for (const std::string& line : lines)
            if (line.find(text) != std::string::npos) return true;
        return false;
    }
};

inline LoadedObj load_path(const std::string& path, Strictness strictness = Strictness::lenient) {
    LoadedObj out;
    const std::string folder = std::filesystem::path(path).parent_path().string();
    Problems problems(strictness);
    try {
        const int mesh = load_obj(path, AssetRules(folder, false), out.scene, problems);
        out.mesh = out.scene.meshes.at(static_cast<std::size_t>(mesh));
        problems.throw_if_any();
    } catch (const Error& error) {
        out.error = error.what();
    }
    out.warnings = problems.warnings();
    out.notes = problems.notes();
    return out;
}

inline LoadedObj load_file(const ObjFiles& files, const std::string& name) {
    return load_path(files.path(name));
}

/// Loads obj as "m.obj" beside the other files, leaving out what is broken.
inline LoadedObj load_text(const std::string& obj,
                           const std::map<std::string, std::string>& others = {}) {
    const ObjFiles files;
    files.write("m.obj", obj);
    for (const auto& [name, text] : others) files.write(name, text);
    return load_file(files, "m.obj");
}

/// The error for obj when nothing broken is left out; "" when it loads.
inline std::string refusal(const std::string& obj,
                           const std::map<std::string, std::string>& others = {}) {
    const ObjFiles files;
    files.write("m.obj", obj);
    for (const auto& [name, text] : others) files.write(name, text);
    return load_path(files.path("m.obj"), Strictness::normal).error;
}

/// Four corners of a unit square in z = 0, to put faces on.
inline const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

}  // namespace tessera::test
