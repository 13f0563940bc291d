#pragma once
// [[material.NAME.layer]]: what lies on a material, one layer upon the other, each driving any of
// its inputs by one mask. Private to the scene reader.

#include "renderer/io/scene_nodes.h"

namespace tessera {

void read_material_layers(const Value& layers, MaterialDesc& material, NodeReader& nodes,
                          const ReadContext& at);

/// Whether an input takes nodes: what light sampling looks up without a hit is read from images
/// only.
inline bool takes_nodes(FloatInput MaterialDesc::*member) {
    return member != &MaterialDesc::emission_luminance && member != &MaterialDesc::geometry_opacity;
}
inline bool takes_nodes(ColorInput MaterialDesc::*member) {
    return member != &MaterialDesc::emission_color;
}

/// What an input takes.
inline NodeType type_of(FloatInput MaterialDesc::*) { return NodeType::scalar; }
inline NodeType type_of(ColorInput MaterialDesc::*member) {
    return member == &MaterialDesc::vector_displacement ? NodeType::vector3 : NodeType::color;
}

/// Puts a value or a node into an input.
void set_input(ColorInput& input, const NodeValue& value);
void set_input(FloatInput& input, const NodeValue& value);

}  // namespace tessera
