#pragma once
// Shader graphs as they are written in a scene: nodes in place, nodes by name, layers. Private to
// the scene reader.

#include <map>
#include <optional>
#include <set>
#include <string>

#include "renderer/api/node_table.h"
#include "renderer/io/scene_reader.h"

namespace tessera {

/// Reads the nodes of one material.
class NodeReader {
public:
    /// named: the material's [material.NAME.node] tables, or null.
    NodeReader(MaterialDesc& material, SceneReader& reader, const Value* named)
        : material_(material), reader_(reader), named_(named) {}

    /// Whether a value is one for this reader: a table with type, node or layers.
    static bool is_graph(const Value& value);

    /// A value for an input of the wanted type; nothing after reporting what is wrong.
    std::optional<NodeValue> read(const Value& value, NodeType wanted, const std::string& key,
                                  const ReadContext& at);

    /// A normal or tangent: a graph, or the image of a normal map.
    std::optional<NodeValue> read_normal(const Value& value, const std::string& key,
                                         const ReadContext& at);

    /// Reads the nodes that nothing has asked for yet: their mistakes count too.
    void read_unused(const Value* own, const ReadContext& at);

    /// What an input holds now, as something a node can take.
    NodeValue node_of(const ColorInput& input, NodeType type);
    NodeValue node_of(const FloatInput& input, NodeType type);
    /// Of nothing the surface's own: its normal or its tangent.
    NodeValue node_of(const NormalInput& input, bool normal);
    /// value times a number.
    NodeValue product(NodeValue value, float factor, const SourceLoc& loc);
    /// `above` on `below` by a mask and a blend mode.
    NodeValue layer(NodeValue below, NodeValue above, NodeValue mask, int blend,
                    const SourceLoc& loc);

private:
    std::optional<NodeValue> read_plain(const Value& value, NodeType wanted, const std::string& key,
                                        const ReadContext& at);
    std::optional<NodeValue> read_named(const Value& table, NodeType wanted, const ReadContext& at);
    std::optional<NodeValue> read_layers(const Value& table, NodeType wanted,
                                         const ReadContext& at);
    std::optional<int> read_node(const Value& table, NodeType wanted, const ReadContext& at);
    std::optional<NodeValue> read_word(const Value& value, NodeOp op, const std::string& key,
                                       const ReadContext& at);
    NodeType type_of(const NodeValue& value) const;
    bool read_image(const Value& table, NodeType wanted, NodeDesc& node, const ReadContext& at);
    std::optional<NodeValue> output_of(int node, const Value& table, NodeType wanted,
                                       const ReadContext& at);
    int push(NodeDesc node);
    int image_node(int texture, bool color);

    MaterialDesc& material_;
    SceneReader& reader_;
    const Value* named_;
    std::map<std::string, int, std::less<>> read_names_;
    std::set<std::string, std::less<>> open_names_;  // being read: one met again goes in a circle
    std::map<int, NodeType> types_;                  // of a node's main output
    int depth_ = 0;
};

/// The words of `blend`, in the order of the node's numbers.
const std::vector<std::string>& blend_modes();

}  // namespace tessera
