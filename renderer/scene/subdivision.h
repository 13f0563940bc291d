#pragma once
// Meshes that ask for it become their subdivided, displaced selves before anything is placed.

#include <string>
#include <vector>

#include "renderer/api/render.h"
#include "renderer/scene/displace.h"
#include "renderer/scene/edge_rates.h"
#include "renderer/scene/flatten.h"

namespace tessera {

/// Per material of the scene: whether it moves a mesh that is subdivided. Warns of displacement on
/// shapes that are not.
std::vector<bool> displaced_materials(const SceneDesc& desc,
                                      const std::vector<FlatInstance>& instances,
                                      Problems& problems);

/// Whether any placed mesh is subdivided.
bool any_subdivided(const SceneDesc& desc, const std::vector<FlatInstance>& instances);

struct SubdivisionInput {
    SceneDesc& desc;
    std::vector<FlatInstance>& instances;  // those with another displacement get another mesh
    const std::vector<Displacement>& displacements;  // per material
    const TextureStore* textures = nullptr;
    ViewScale view;
    int threads = 0;
    std::string isa;
    Problems& problems;
};

/// Throws Error(scene) for a mesh that would become too large or cannot be evaluated.
std::vector<SubdivisionStatistics> subdivide_meshes(const SubdivisionInput& in);

}  // namespace tessera
