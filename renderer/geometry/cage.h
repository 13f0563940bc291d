#pragma once
// A described mesh as the control cage of a surface: places that are equal made one, edges known.

#include <cstdint>
#include <vector>

#include "renderer/api/scene_desc.h"
#include "renderer/core/vec.h"

namespace tessera {

struct Cage {
    struct Face {
        std::uint32_t first;    // corner
        std::uint32_t corners;  // 3 or 4
        std::uint32_t source;   // face of the description
    };
    struct Edge {
        std::uint32_t a, b;     // places, a < b
        bool triangle = false;  // some face at it is one
    };

    Vec3d origin;               // the middle of its bounds
    std::vector<Vec3f> places;  // about the origin; one more than there are: Embree reads 16 bytes
    std::vector<Face> faces;
    std::vector<Edge> edges;
    // Per corner, face after face:
    std::vector<std::uint32_t> place;
    std::vector<std::uint32_t> edge;    // to the face's next corner
    std::vector<std::uint32_t> source;  // entry of the description's index arrays
    std::vector<std::uint32_t> wedge;   // equal where place, texture coordinates, material (and,
                                        // if asked for, normal) are
    std::uint32_t wedges = 0;
    std::uint32_t dropped = 0;  // faces with fewer than three places

    std::uint32_t next(const Face& f, std::uint32_t k) const { return (k + 1) % f.corners; }
    Vec3f at(const Face& f, std::uint32_t k) const { return places[place[f.first + k]]; }
    /// The most faces that meet at a place.
    std::uint32_t valence() const;
    std::size_t bytes() const noexcept;
};

/// Positions that are equal become one place, so that a mesh whose file repeats them is whole.
Cage make_cage(const MeshDesc& mesh, bool split_by_normal);

/// Entries of the description's arrays for a corner.
inline std::uint32_t uv_entry(const MeshDesc& m, std::uint32_t corner) {
    return m.uv_index.empty() ? m.position_index[corner] : m.uv_index[corner];
}
inline std::uint32_t normal_entry(const MeshDesc& m, std::uint32_t corner) {
    return m.normal_index.empty() ? m.position_index[corner] : m.normal_index[corner];
}

}  // namespace tessera
