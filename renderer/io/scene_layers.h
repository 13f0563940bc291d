#pragma once
// [[material.NAME.layer]]: what lies on a material, one layer upon the other, each driving any of
// its inputs by one mask. Private to the scene reader.

#include "renderer/io/scene_nodes.h"

namespace tessera {

void read_material_layers(const Value& layers, MaterialDesc& material, NodeReader& nodes,
                          const ReadContext& at);

/// What an input takes.
inline NodeType type_of(FloatInput MaterialDesc::*) { return NodeType::scalar; }
inline NodeType type_of(ColorInput MaterialDesc::*member) {
    return member == &MaterialDesc::vector_displacement ? NodeType::vector3 : NodeType::color;
}

/// Puts a value or a node into an input.
void set_input(ColorInput& input, const NodeValue& value);
void set_input(FloatInput& input, const NodeValue& value);
void set_input(NormalInput& input, const NodeValue& value);

/// Normals and tangents by name.
struct NormalKey {
    const char* name;
    NormalInput MaterialDesc::*member;
    bool takes_maps;
    const char* help;
};
inline constexpr NormalKey kNormalKeys[] = {
    {"geometry_normal", &MaterialDesc::geometry_normal, true,
     "Tangent-space normal map, or a node that gives a normal in the world."},
    {"geometry_coat_normal", &MaterialDesc::geometry_coat_normal, true,
     "The coat's own normal; without it the coat is even over a bumpy base."},
    {"geometry_tangent", &MaterialDesc::geometry_tangent, false,
     "A node that gives the way highlights stretch, in the world; else along u."},
    {"geometry_coat_tangent", &MaterialDesc::geometry_coat_tangent, false,
     "The coat's own; else the surface's."},
};

}  // namespace tessera
