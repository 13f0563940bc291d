#pragma once
// Shapes ready to trace: what Embree and the interpolation share. Positions are floats about the
// scene's (or, for instanced shapes, the shape's) own origin.

#include <cstdint>
#include <vector>

#include "renderer/core/affine.h"
#include "renderer/core/vec.h"

namespace tessera {

/// Faces that become one Embree geometry: a run of the mesh's faces, all triangles or all quads.
struct MeshPart {
    std::uint32_t first_face = 0;
    std::uint32_t faces = 0;
    bool quads = false;
    bool cutout = false;  // hits are passed to the opacity test
};

struct Mesh {
    std::vector<Vec3f> positions;  // one more than used: Embree reads 16 bytes at the last vertex
    std::vector<Vec3f> normals;
    std::vector<Vec2f> uvs;
    std::vector<Color> colors;  // per position
    std::vector<std::uint32_t> position_index, normal_index,
        uv_index;                              // 3 per triangle, then 4 per quad
    std::vector<std::uint16_t> face_material;  // slot; empty: slot 0
    std::vector<std::uint32_t> face_object;    // empty: 0
    std::vector<std::int32_t> materials;       // slot -> scene material
    std::vector<MeshPart> parts;
    std::uint32_t triangles = 0, quads = 0;

    std::uint32_t faces() const noexcept { return triangles + quads; }
    /// First entry of a face in the index arrays.
    std::size_t corner(std::uint32_t face) const noexcept {
        return face < triangles ? std::size_t(face) * 3
                                : std::size_t(triangles) * 3 + std::size_t(face - triangles) * 4;
    }
    std::uint32_t material_slot(std::uint32_t face) const noexcept {
        return face_material.empty() ? 0 : face_material[face];
    }
    std::size_t bytes() const noexcept;
};

struct Sphere {
    Vec3f center;
    float radius = 1;
    std::int32_t material = -1;
    bool cutout = false;  // as MeshPart's
};

struct Disc {
    Vec3f center;
    Vec3f normal;  // unit
    float radius = 1;
    std::int32_t material = -1;
    bool cutout = false;
};

enum class PlacedKind : std::uint8_t { mesh, sphere, disc };

/// A shape put into the scene. Placed directly (to_world is the identity and the shape's
/// coordinates are the scene's) or through an Embree instance.
struct Placement {
    Affinef to_world;
    std::uint32_t shape = 0;     // index among the shapes of its kind
    std::int32_t material = -1;  // replaces the shape's materials
    std::int32_t light = -1;     // the light that this shape is the body of
    PlacedKind kind = PlacedKind::mesh;
    bool instanced = false;
    bool camera_visible = true;
    float condition = 1;  // of to_world: how much a rounding on the way in grows on the way out

    /// Places through an Embree instance.
    void instance_at(const Affined& to_world);
};

/// Everything that can be hit.
struct Geometry {
    std::vector<Mesh> meshes;
    std::vector<Sphere> spheres;
    std::vector<Disc> discs;
    std::vector<Placement> placements;
};

}  // namespace tessera
