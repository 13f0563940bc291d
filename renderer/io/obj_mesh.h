#pragma once
// From checked OBJ faces to a mesh of triangles and quads.

#include <string>
#include <vector>

#include "renderer/io/obj_checks.h"

namespace tessera {

/// Which name a material slot of the mesh has in the file.
struct ObjMaterialUse {
    std::string name;
    std::uint32_t line = 0;  // of the usemtl; 0: faces before any usemtl
};

struct ObjMesh {
    MeshDesc mesh;                          // materials is left empty
    std::vector<ObjMaterialUse> materials;  // per slot
    std::uint64_t degenerate = 0;           // faces dropped for having no area
    std::uint64_t fanned = 0;               // polygons too tangled for ear clipping
};

/// numbers: through check_faces and resolve_normals. Splits polygons, drops what has no area, and
/// keeps only the vertices that faces use. `name` is the object's name where the file gives none.
ObjMesh build_obj_mesh(ObjNumbers numbers, ObjStatements statements, const std::string& name);

}  // namespace tessera
