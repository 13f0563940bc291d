#pragma once
// Gathers NameIds while a scene is built.

#include <map>

#include "renderer/scene/flatten.h"
#include "renderer/scene/name_ids.h"

namespace tessera {

/// Told of everything as it is placed, while the description still has its names.
class NameCollector {
public:
    explicit NameCollector(const SceneDesc& desc);

    /// The mesh became the next of Geometry::meshes.
    void add_mesh(const MeshDesc& mesh);
    /// The instance became the next of Geometry::placements.
    void add_placement(const FlatInstance& instance, const Placement& placed);
    /// The bodies of the described lights are the last placements.
    NameIds finish(const Geometry& geometry);

private:
    // The names of a kind, and how much surface bears each; less than 0: nothing does.
    struct Names {
        std::map<std::string, std::uint32_t> index;
        std::vector<double> areas;

        std::uint32_t of(const std::string& name);
        void bear(std::uint32_t name, double area);
        /// Fills the list with what is borne; gives keys by index.
        std::vector<std::uint32_t> list(NameList& out) const;
    };

    Names& names(NameKind kind) { return names_[static_cast<std::size_t>(kind)]; }
    std::uint32_t add_object(const std::string& name);
    void add_light_bodies();
    void measure(const Geometry& geometry);
    void bear_material(std::int32_t material, double area) {
        names(NameKind::material).bear(out_.materials_[material + 1], area);
    }

    const SceneDesc& desc_;
    NameIds out_;  // with indices into names_ for keys until the end
    std::array<Names, kNameKinds> names_;
    std::vector<std::uint32_t> mesh_objects_;        // per mesh: its first in objects_
    std::vector<std::uint32_t> assets_;              // per described instance
    std::map<std::uint32_t, std::uint32_t> copies_;  // per asset
};

}  // namespace tessera
