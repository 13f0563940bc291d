#pragma once
// Vertex normals from a mesh's faces.

#include <cstdint>
#include <span>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// Replaces the normals of a mesh whose index arrays are one. place: which vertices are the same
/// point. smooth: they share one normal; else only where their normals agreed before.
void make_normals(MeshDesc& mesh, std::span<const std::uint32_t> place, std::uint32_t places,
                  bool smooth);

}  // namespace tessera
