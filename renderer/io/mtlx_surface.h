#pragma once
// The surface shaders of MaterialX as our material. Private to the MaterialX reader.

#include "renderer/api/openpbr_inputs.h"
#include "renderer/io/mtlx_graph.h"

namespace tessera {

/// Puts values into a material's inputs, with the checks that a scene file's own values pass.
class MtlxInputs {
public:
    MtlxInputs(MtlxGraph& graph, const MtlxGraph::NodeAt& shader)
        : graph_(graph), shader_(shader) {}

    /// What the shader's input is given; nothing when it is given nothing.
    std::optional<MtlxValue> given(std::string_view name);
    /// The same, or what it is by default.
    MtlxValue number(std::string_view name, float otherwise);
    MtlxValue color(std::string_view name, const Float3& otherwise);
    /// A number that must be written.
    std::optional<float> constant(std::string_view name);

    void set(FloatInput MaterialDesc::*member, const MtlxValue& value);
    void set(ColorInput MaterialDesc::*member, const MtlxValue& value);
    void set_thin_walled(std::string_view name);
    /// A normal or tangent.
    void set_normal(std::string_view name, NormalInput MaterialDesc::*member);
    /// Reports inputs that are none of names.
    void check_names(const std::vector<std::string>& names);
    void unsupported(std::string_view name, const std::string& why = "");

    MtlxGraph& graph() { return graph_; }
    const SourceLoc& loc(std::string_view name) const;

private:
    std::string subject(std::string_view name) const;

    MtlxGraph& graph_;
    const MtlxGraph::NodeAt& shader_;
};

void read_open_pbr_surface(MtlxGraph& graph, const MtlxGraph::NodeAt& shader);
/// Autodesk Standard Surface; docs/materialx.md is the table.
void read_standard_surface(MtlxGraph& graph, const MtlxGraph::NodeAt& shader);

/// Of a metal with reflectivity r at normal incidence and edge tint g after Gulbrandsen: what its
/// reflectance at 82 degrees is to Schlick's, OpenPBR's specular_color.
float f82_of_edge_tint(float reflectivity, float edge_tint) noexcept;

}  // namespace tessera
