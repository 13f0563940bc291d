#pragma once
// Shading normals of an OBJ: its own, those of its smoothing groups, or none.

#include "renderer/io/obj_checks.h"

namespace tessera {

/// Gives every corner of a checked OBJ a unit normal, or clears all normals when no face has a
/// shading normal. A face whose corners all name a usable vn keeps them; another one in a smoothing
/// group gets the mean over the group's faces at each vertex, weighted by angle times area; any
/// other gets its own normal.
void resolve_normals(ObjNumbers& numbers, const ObjStatements& statements);

}  // namespace tessera
