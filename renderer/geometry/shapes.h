#pragma once
// Shapes ready to trace: what Embree and the interpolation share. Positions are floats about the
// scene's (or, for instanced shapes, the shape's) own origin.

#include <cstdint>
#include <new>
#include <vector>

#include "renderer/core/affine.h"
#include "renderer/core/crease_tree.h"
#include "renderer/core/vec.h"

namespace tessera {

/// Faces that become one Embree geometry: a run of the mesh's faces, all triangles or all quads.
struct MeshPart {
    std::uint32_t first_face = 0;
    std::uint32_t faces = 0;
    bool quads = false;
    bool cutout = false;  // hits are passed to the opacity test
};

/// Memory that starts on a cache line, so that a record of half a line never lies on two.
template <class T>
struct LineAllocator {
    using value_type = T;
    static constexpr std::align_val_t kLine{64};
    LineAllocator() = default;
    template <class U>
    LineAllocator(const LineAllocator<U>&) {}
    T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
    void deallocate(T* p, std::size_t) { ::operator delete(p, kLine); }
    bool operator==(const LineAllocator&) const = default;
};

struct Mesh {
    /// Vertices as records of `stride` floats: position, then normal, texture coordinates, colour
    /// where the mesh has them. One float more than used: Embree reads 16 bytes at a position.
    std::vector<float, LineAllocator<float>> vertices;
    std::uint32_t stride = 3, normal_at = 0, uv_at = 0,
                  color_at = 0;        // in floats; 0: there is none
    std::vector<std::uint32_t> index;  // 3 per triangle, then 4 per quad

    /// Sets the record; before any vertex is added.
    void lay_out(bool normals, bool uvs, bool colors);
    /// Adds a vertex with the position; the rest is zero. Returns its record.
    float* add_vertex(Vec3f position);
    /// After the last vertex.
    void finish_vertices() { vertices.push_back(0); }

    const float* record(std::uint32_t vertex) const noexcept {
        return &vertices[std::size_t(vertex) * stride];
    }
    std::size_t vertex_count() const noexcept { return vertices.size() / stride; }
    Vec3f position(std::uint32_t vertex) const noexcept { return triple(vertex, 0); }
    Vec3f normal(std::uint32_t vertex) const noexcept { return triple(vertex, normal_at); }
    Color color(std::uint32_t vertex) const noexcept { return triple(vertex, color_at); }
    Vec2f uv(std::uint32_t vertex) const noexcept {
        const float* r = record(vertex) + uv_at;
        return {r[0], r[1]};
    }
    Vec3f triple(std::uint32_t vertex, std::uint32_t at) const noexcept {
        const float* r = record(vertex) + at;
        return {r[0], r[1], r[2]};
    }

    std::vector<std::uint16_t> face_material;  // slot; empty: slot 0
    std::vector<std::uint32_t> face_object;    // empty: 0
    std::vector<std::int32_t> materials;       // slot -> scene material
    std::vector<MeshPart> parts;
    CreaseTree creases;  // in the coordinates of the file; empty unless a material asks
    std::uint32_t triangles = 0, quads = 0;

    std::uint32_t faces() const noexcept { return triangles + quads; }
    /// First entry of a face in the index.
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
    Affinef to_object;           // from the scene to the coordinates of the shape's file
    float object_scale = 1;      // of to_object, along the axis that it stretches most
    std::uint32_t shape = 0;     // index among the shapes of its kind
    std::int32_t material = -1;  // replaces the shape's materials
    std::int32_t light = -1;     // the light that this shape is the body of
    PlacedKind kind = PlacedKind::mesh;
    bool instanced = false;
    bool camera_visible = true;
    float condition = 1;  // of to_world: how much a rounding on the way in grows on the way out

    /// Sets to_object from where the shape's file is put in the scene.
    void objects_are_at(const Affined& to_scene);
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
