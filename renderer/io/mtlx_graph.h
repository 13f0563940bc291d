#pragma once
// Node graphs of MaterialX as the nodes of one material: references followed, graphs and nodes that
// the document defines put in place. Private to the MaterialX reader.

#include <deque>
#include <initializer_list>
#include <map>
#include <set>
#include <tuple>

#include "renderer/api/node_table.h"
#include "renderer/image/colour_space.h"
#include "renderer/io/mtlx_value.h"

namespace tessera {

/// What the materials of one document share.
struct MtlxReading {
    const MtlxDocument& document;
    SceneReader& reader;
    const ColorSpaces& colors;
    std::multimap<std::string_view, const MtlxElement*> definitions = {};  // nodedefs by category
    std::size_t nodes = 0;                                                 // of all its materials
    std::set<std::string> said = {};  // problems of what several materials use are told once

    /// Something that cannot be read: an error, and left out when lenient.
    void damage(const SourceLoc& loc, const std::string& message);
};

class MtlxGraph {
public:
    /// Where names are looked up: in a graph (null: the document), which stands for a node of its
    /// own definition (`instance`, in `outer`) or for itself.
    struct Scope {
        const MtlxElement* graph = nullptr;
        const MtlxElement* instance = nullptr;
        const Scope* outer = nullptr;
    };
    /// A node as it is asked for: one of its outputs, "" the main one.
    struct NodeAt {
        const MtlxElement& node;
        const Scope& scope;
        MtlxType type;
        std::string output = {};
    };

    MtlxGraph(MtlxReading& reading, MaterialDesc& material)
        : reading_(reading), material_(material) {}

    const Scope& root() const { return root_; }
    MtlxReading& reading() { return reading_; }
    MaterialDesc& material() { return material_; }

    /// What an input or output element is given; nothing when it is given nothing, or after
    /// reporting what is wrong.
    std::optional<MtlxValue> value_of(const MtlxElement& element, const Scope& scope);
    /// The same of an input by its name.
    std::optional<MtlxValue> input(const NodeAt& at, std::string_view name);
    /// The element that a shader input of a material leads to, and where it stands.
    std::optional<NodeAt> shader(const MtlxElement& input, const Scope& scope);

    /// A number that must be written, not computed.
    float number(const NodeAt& at, std::string_view name, float otherwise);
    std::string text(const NodeAt& at, std::string_view name, const std::string& otherwise);

    /// Adds a node with all its inputs given, and yields its main output.
    NodeValue emit(NodeOp op, std::initializer_list<NodeValue> inputs, const SourceLoc& loc);
    /// Adds a node as it is; returns its index. Throws Error(scene) past 4096, or past a million of
    /// all materials.
    int push(NodeDesc node);
    NodeValue product(const NodeValue& value, float factor, const SourceLoc& loc);

    void damage(const SourceLoc& loc, const std::string& message) { reading_.damage(loc, message); }
    void damage(const NodeAt& at, const std::string& message) {
        reading_.damage(at.node.loc, at.node.subject() + ": " + message);
    }

private:
    std::optional<MtlxValue> follow(const MtlxElement& element, const Scope& scope);
    std::optional<MtlxValue> written(const MtlxElement& element, MtlxType type);
    std::optional<MtlxValue> from_interface(const MtlxElement& element, const Scope& scope,
                                            const std::string& name);
    std::optional<MtlxValue> from_graph(const MtlxElement& element, const std::string& name,
                                        const Scope& scope);
    std::optional<MtlxValue> from_geometry(const MtlxElement& element, const std::string& name);
    std::optional<MtlxValue> from_node(const MtlxElement& element, const std::string& name,
                                       const Scope& scope);
    std::optional<MtlxValue> custom_node(const NodeAt& at, const MtlxElement& definition);
    const MtlxElement* find(const Scope& scope, const std::string& name) const;
    const MtlxElement* output_of(const MtlxElement& graph, const std::string* name,
                                 const MtlxElement& from);
    const Scope* scope_of(const MtlxElement& graph, const MtlxElement* instance,
                          const Scope& outer);

    MtlxReading& reading_;
    MaterialDesc& material_;
    Scope root_;
    std::deque<Scope> scopes_;
    std::map<std::tuple<const MtlxElement*, const MtlxElement*, const Scope*>, const Scope*>
        known_scopes_;
    std::map<std::tuple<const MtlxElement*, const Scope*, std::string>, std::optional<MtlxValue>>
        known_;
    std::set<std::pair<const MtlxElement*, const Scope*>> open_;
    int depth_ = 0;
};

NodeDesc make_node(NodeOp op, const SourceLoc& loc);
inline NodeValue node_constant(float x) { return {{x, x, x}}; }

/// A node of the standard library, or nothing after reporting.
std::optional<MtlxValue> read_mtlx_node(MtlxGraph& graph, const MtlxGraph::NodeAt& at);

/// image, tiledimage, triplanarprojection.
std::optional<MtlxValue> read_mtlx_image(MtlxGraph& graph, const MtlxGraph::NodeAt& at);
std::optional<MtlxValue> read_mtlx_triplanar(MtlxGraph& graph, const MtlxGraph::NodeAt& at);
std::optional<MtlxValue> read_mtlx_normal_map(MtlxGraph& graph, const MtlxGraph::NodeAt& at);

/// An image at the surface's own coordinates, as inputs of a material read them: what a value comes
/// to when it is one, with constant factors and one channel at most.
struct MtlxPlainImage {
    int texture = -1;
    Channel channel = Channel::automatic;
    bool invert = false;
    Float3 factor{1, 1, 1};
};
std::optional<MtlxPlainImage> plain_image(MtlxGraph& graph, const NodeValue& value);

}  // namespace tessera
