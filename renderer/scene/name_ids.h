#pragma once
// What the things in a scene are called, and from a hit to its names in a look-up or two. Built
// only for pictures that hold them and materials that go by them.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/api/scene_desc.h"
#include "renderer/core/surface_point.h"
#include "renderer/film/pass.h"
#include "renderer/geometry/shapes.h"

namespace tessera {

/// Object: OBJ 'o', else 'g', else the file's stem; a sphere's, disc's or light's own name. Asset:
/// the outermost instance's name.
enum class NameKind : std::uint8_t { object, material, asset };
inline constexpr int kNameKinds = 3;

/// One kind's names, those of everything placed in the scene. Things of one name are one.
struct NameList {
    std::vector<std::string> names;  // sorted
    std::vector<std::uint32_t> ids;  // Cryptomatte's, each once, by key
};

/// Per kind: an index into NameList::ids. The larger the surface of a name, the smaller its key.
using NameKeys = std::array<std::uint32_t, kNameKinds>;

/// Whether a pass asks for names, or a node of a material.
bool wants_name_ids(const Passes& passes);
bool wants_name_ids(const MaterialDesc& material);

class NameIds {
public:
    NameKeys keys(const Geometry& geometry, const SurfacePoint& s) const noexcept {
        const Placement& placed = geometry.placements[s.placement];
        const Placed& names = placements_[s.placement];
        std::uint32_t slot = 0;
        if (placed.kind == PlacedKind::mesh) {
            const Mesh& mesh = geometry.meshes[placed.shape];
            if (!mesh.face_object.empty()) slot = mesh.face_object[s.face];
        }
        return {objects_[names.first_object + slot], materials_[s.material + 1], names.asset};
    }
    std::uint32_t id(NameKind kind, const NameKeys& keys) const noexcept {
        return list(kind).ids[keys[static_cast<std::size_t>(kind)]];
    }
    /// Which of all the placements that an instance's name stands for, in their order.
    std::uint32_t copy(const SurfacePoint& s) const noexcept {
        return placements_[s.placement].copy;
    }
    const NameList& list(NameKind kind) const noexcept {
        return lists_[static_cast<std::size_t>(kind)];
    }
    std::size_t bytes() const noexcept;

private:
    friend class NameCollector;
    struct Placed {
        std::uint32_t asset = 0, first_object = 0, copy = 0;
    };
    std::vector<Placed> placements_;
    std::vector<std::uint32_t> objects_;    // runs, by slots of Mesh::face_object
    std::vector<std::uint32_t> materials_;  // the first is that of what has none: bodies of lights
    std::array<NameList, kNameKinds> lists_;
};

}  // namespace tessera
