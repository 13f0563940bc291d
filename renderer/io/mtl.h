#pragma once
// MTL libraries of one OBJ: which files there are, and a material by its name as a MaterialDesc.
// The mapping onto OpenPBR is stated in docs/mtl-mapping.md.

#include <memory>
#include <string>

#include "renderer/api/scene_desc.h"
#include "renderer/io/assets.h"
#include "renderer/io/tally.h"

namespace tessera {

class MtlLibraries {
public:
    /// Materials and textures are appended to scene when they are asked for. All references must
    /// outlive this.
    MtlLibraries(const AssetRules& assets, SceneDesc& scene, Problems& problems);
    ~MtlLibraries();
    MtlLibraries(const MtlLibraries&) = delete;
    MtlLibraries& operator=(const MtlLibraries&) = delete;

    /// What follows 'mtllib' on a line of the OBJ obj_path: one file whose name may hold spaces, or
    /// several (blanks escaped by '\' belong to a name). A file that is missing is a warning of the
    /// OBJ's tally, one outside the scene's folders an error.
    void add(const std::string& names, const std::string& obj_path, std::uint32_t line,
             Tally& obj_tally);

    /// Index in scene.materials, or -1 when no library has the name. The first library counts.
    int material(const std::string& name);

    /// Tells the counts of repeated warnings.
    void finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
