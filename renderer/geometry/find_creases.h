#pragma once
// Where a mesh's faces meet at an angle.

#include <vector>

#include "renderer/api/scene_desc.h"
#include "renderer/core/crease_tree.h"

namespace tessera {

/// Edges between faces whose normals differ by `least` radians or more, in the mesh's own
/// coordinates; the front is the side that the faces' winding says. Corners at one place are one
/// corner. An edge of one face alone is none; one of many is taken by its most convex and its most
/// concave pair of neighbours.
std::vector<Crease> find_creases(const MeshDesc& mesh, float least);

}  // namespace tessera
