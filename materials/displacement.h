#pragma once
// What moves a material's surface before it is traced, compiled.

#include "materials/graph.h"
#include "materials/shade_input.h"
#include "renderer/api/scene_desc.h"
#include "renderer/core/frame.h"

namespace tessera {

/// Whether a material moves its surface.
bool displaces(const MaterialDesc& desc);

class Displacement {
public:
    /// None.
    Displacement() = default;
    /// desc's texture indices are those of the TextureStore.
    explicit Displacement(const MaterialDesc& desc);

    bool moves() const noexcept { return moves_; }
    /// Reads the tangent along u, which only texture coordinates give.
    bool needs_tangent() const noexcept { return vector_ && space_ == DisplacementSpace::tangent; }

    /// How far the point moves, scene units, in the axes of `tangent`: along u, across it, normal.
    /// May not be finite, if the graph is not.
    Vec3f offset(const ShadeInput& in, const Frame& tangent,
                 const TextureStore* store) const noexcept;

private:
    /// A wire, or an image by itself, times a factor.
    struct Source {
        Wire wire = {};
        int texture = -1;
        Channel channel = Channel::automatic;
        bool invert = false;
        Vec3f factor{0.0f};
    };
    template <class Input>
    Source source_of(const MaterialDesc& desc, const Input& input);
    Vec3f value(const Source& source, GraphRun& run, const ShadeInput& in,
                const TextureStore* store) const noexcept;

    Graph graph_;
    Source height_, direction_;
    float scale_ = 1, offset_ = 0;
    DisplacementSpace space_ = DisplacementSpace::tangent;
    bool moves_ = false, vector_ = false;
};

}  // namespace tessera
