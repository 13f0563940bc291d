#pragma once
// Scene files in a folder of their own, and what a test asks of the scene they make.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "renderer/api/scene_desc.h"
#include "tests/support/temp_folder.h"

namespace tessera {

/// A folder of scene files that goes when the test ends.
class SceneFolder {
public:
    std::string path(const std::string& name) const { return folder_.path() + "/" + name; }
    std::string write(const std::string& name, const std::string& text) const {
        const std::filesystem::path path = folder_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << text;
        return path.string();
    }

    SceneDesc load(const std::string& text, const std::vector<std::string>& set = {}) const {
        return load_scene(write("s.toml", "tessera = 1\n" + text), {.set = set});
    }

    /// What load says, without the folder; "" when it says nothing.
    std::string failure(const std::string& text, const std::vector<std::string>& set = {}) const {
        try {
            load(text, set);
        } catch (const Error& error) {
            std::string message = error.what();
            const std::string prefix = folder_.path() + "/";
            for (auto at = message.find(prefix); at != std::string::npos;
                 at = message.find(prefix)) {
                message.erase(at, prefix.size());
            }
            return message;
        }
        return {};
    }

private:
    TempFolder folder_;
};

inline bool contains(const std::vector<std::string>& lines, const std::string& part) {
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
        return line.find(part) != std::string::npos;
    });
}

inline constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
inline constexpr const char* kTwoMaterials =
    "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nusemtl blue\nf 3 2 1\n";
inline constexpr const char* kTwoMaterialsMtl = "newmtl red\nKd 0.5 0 0\nnewmtl blue\nKd 0 0 0.5\n";
inline constexpr const char* kLight = "[[light]]\nname = 'key'\ntype = 'point'\n";

inline int material_index(const SceneDesc& scene, const std::string& name) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (scene.materials[i].name == name) return static_cast<int>(i);
    }
    return -1;
}

inline const MaterialDesc& material(const SceneDesc& scene, const std::string& name) {
    const int index = material_index(scene, name);
    REQUIRE(index >= 0);
    return scene.materials[static_cast<std::size_t>(index)];
}

}  // namespace tessera
