// Nodes of MaterialX's standard library: those of our table as they are, others by the nodes that
// come to the same.

#include <algorithm>
#include <array>

#include "renderer/core/nearest_name.h"
#include "renderer/io/mtlx_graph.h"
#include "renderer/io/mtlx_rewrites.h"

namespace tessera {
namespace {

using At = MtlxGraph::NodeAt;
using Kind = MtlxValue::Kind;

/// Inputs that must keep MaterialX's default: we have nothing else.
struct FixedInput {
    std::string_view category, input;
};
constexpr std::array<FixedInput, 3> kZeroInputs{
    {{"texcoord", "index"}, {"geomcolor", "index"}, {"place2d", "operationorder"}}};

bool must_be_zero(std::string_view category, std::string_view input) {
    return std::any_of(kZeroInputs.begin(), kZeroInputs.end(), [&](const FixedInput& f) {
        return f.category == category && f.input == input;
    });
}

/// Whether a value goes into an input of the table, for a node of the given type.
bool fits(MtlxType type, NodeType wanted, MtlxType node) {
    switch (wanted) {
        case NodeType::scalar:
            return is_number(type);
        case NodeType::color:
            return is_color(type);
        case NodeType::vector2:
            return type == MtlxType::vector2;
        case NodeType::vector3:
            return type == MtlxType::vector3 || type == MtlxType::vector2;
        case NodeType::any:
            return is_number(type) || type == node;
    }
    return false;
}

/// Whether a node of the table can be of a type.
bool gives(const NodeInfo& info, MtlxType type) {
    if (width_of(type) == 0) return false;
    switch (info.output) {
        case NodeType::scalar:
            return is_number(type) || (info.op == NodeOp::luminance && is_color(type));
        case NodeType::color:
            return is_color(type) || (info.op == NodeOp::combine3 && type == MtlxType::vector3);
        case NodeType::vector2:
            return type == MtlxType::vector2;
        case NodeType::vector3:
            return type == MtlxType::vector3;
        case NodeType::any:
            return true;
    }
    return false;
}

/// MaterialX's reference turns coordinates the other way round than our node does.
bool turns(NodeOp op, std::string_view input) {
    return ((op == NodeOp::rotate2d || op == NodeOp::rotate3d) && input == "amount") ||
           (op == NodeOp::place2d && input == "rotate");
}

class TableNode {
public:
    TableNode(MtlxGraph& graph, const At& at, const NodeInfo& info)
        : graph_(graph), at_(at), info_(info), desc_(make_node(info.op, at.node.loc)) {}

    std::optional<MtlxValue> read() {
        if (!gives(info_, at_.type)) {
            graph_.damage(at_, "does not come in type '" + written_type() + "'");
            return std::nullopt;
        }
        fourth_ = desc_;
        for (const MtlxElement* element : at_.node.children)
            if (element->category == "input") read_input(*element);
        MtlxValue out{.type = at_.type, .source = &at_.node};
        const int output = output_number();
        if (output < 0) return std::nullopt;
        if (output > 0) out.type = beside_type(output);
        out.rgb = {{}, graph_.push(std::move(desc_)), output};
        if (has_fourth(out.type)) out.fourth = componentwise() ? fourth_of() : alpha_;
        return out;
    }

private:
    std::string written_type() const {
        const std::string* type = at_.node.find("type");
        return type ? *type : "";
    }
    bool componentwise() const { return info_.output == NodeType::any; }
    NodeValue fourth_of() { return {{}, graph_.push(std::move(fourth_))}; }

    int output_number() {
        if (at_.output.empty() || at_.output == "out") return 0;
        std::vector<std::string> names{"out"};
        for (const NodeOutputInfo& o : info_.outputs()) {
            names.emplace_back(o.name);
            if (o.name == at_.output) return static_cast<int>(names.size()) - 1;
        }
        graph_.damage(at_, "has no output '" + at_.output + "'" + did_you_mean(at_.output, names));
        return -1;
    }

    MtlxType beside_type(int output) const {
        switch (info_.outputs()[static_cast<std::size_t>(output - 1)].type) {
            case NodeType::color:
                return MtlxType::color3;
            case NodeType::vector3:
                return MtlxType::vector3;
            default:
                return MtlxType::scalar;
        }
    }

    void read_input(const MtlxElement& element) {
        const std::string name = element.name();
        const auto inputs = info_.inputs();
        const auto input = std::find_if(inputs.begin(), inputs.end(),
                                        [&](const NodeInputInfo& i) { return i.name == name; });
        if (input == inputs.end()) return read_beside(element, name);
        auto value = graph_.value_of(element, at_.scope);
        if (!value) return;
        if (!fits(value->type, input->type, at_.type)) {
            graph_.damage(element.loc, at_.node.subject() + ": " + name + " is of type " +
                                           std::string(name_of(value->type)) +
                                           ", which does not go there (see 'convert', 'extract')");
            return;
        }
        // The third place of a pair holds nothing; sums over components must not see it.
        if (input->type == NodeType::vector3 && value->type == MtlxType::vector2 &&
            !value->is_constant())
            value->rgb = graph_.emit(NodeOp::multiply, {value->rgb, {{1, 1, 0}}}, element.loc);
        if (turns(info_.op, name)) value->rgb = graph_.product(value->rgb, -1, element.loc);
        const auto i = static_cast<std::size_t>(input - inputs.begin());
        desc_.inputs[i] = value->rgb;
        fourth_.inputs[i] = has_fourth(value->type) ? value->fourth : value->rgb;
        desc_.given[i] = fourth_.given[i] = true;
        if (name == "in" && has_fourth(value->type)) alpha_ = value->fourth;
    }

    /// Inputs that our node lacks.
    void read_beside(const MtlxElement& element, const std::string& name) {
        if (must_be_zero(at_.node.category, name)) {
            const auto value = graph_.value_of(element, at_.scope);
            const bool zero =
                value &&
                (value->text == "0" || value->text == "SRT" ||
                 (value->is_constant() && is_number(value->type) && value->rgb.value[0] == 0));
            if (value && !zero)
                graph_.damage(element.loc, at_.node.subject() + ": " + name + " must be 0 here");
            return;
        }
        if (info_.op == NodeOp::bump && (name == "tangent" || name == "bitangent")) {
            const auto value = graph_.value_of(element, at_.scope);
            if (value && value->kind != Kind::surface_tangent)
                graph_.damage(element.loc,
                              at_.node.subject() + ": " + name + " must be the surface's own");
            return;
        }
        if (name == "lumacoeffs") {
            if (!is_usual_luma(element))
                graph_.damage(
                    element.loc,
                    at_.node.subject() + ": lumacoeffs are those of the working space, no others");
            return;
        }
        std::vector<std::string> names;
        for (const NodeInputInfo& i : info_.inputs()) names.emplace_back(i.name);
        graph_.damage(element.loc, at_.node.subject() + ": has no input '" + name + "'" +
                                       did_you_mean(name, names));
    }

    /// What documents write for want of a better knowledge of the working space.
    bool is_usual_luma(const MtlxElement& element) const {
        const std::string* text = element.find("value");
        const auto numbers = text ? mtlx_numbers(*text) : std::nullopt;
        if (!numbers || numbers->size() != 3) return false;
        constexpr std::array<std::array<float, 3>, 2> kUsual{
            {{0.2722287f, 0.6740818f, 0.0536895f}, {0.2126f, 0.7152f, 0.0722f}}};
        return std::any_of(kUsual.begin(), kUsual.end(), [&](const std::array<float, 3>& usual) {
            for (std::size_t i = 0; i < 3; ++i)
                if (std::abs((*numbers)[i] - usual[i]) > 1e-3f) return false;
            return true;
        });
    }

    MtlxGraph& graph_;
    const At& at_;
    const NodeInfo& info_;
    NodeDesc desc_, fourth_;
    NodeValue alpha_{{1, 1, 1}};
};

/// constant adds no node.
std::optional<MtlxValue> read_constant(MtlxGraph& graph, const At& at) {
    auto value = graph.input(at, "value");
    if (!value) value = MtlxValue{.type = at.type, .fourth = {{0, 0, 0}}, .source = &at.node};
    if (value->type == at.type) return value;
    graph.damage(at, "value is of type " + std::string(name_of(value->type)));
    return std::nullopt;
}

std::optional<MtlxValue> read_position(MtlxGraph& graph, const At& at) {
    const std::string space = graph.text(at, "space", "object");
    if (space != "object" && space != "model" && space != "world") {
        graph.damage(at, "space is '" + space + "', must be 'object', 'model' or 'world'");
        return std::nullopt;
    }
    const float world = space == "world" ? 1 : 0;
    return MtlxValue{.type = MtlxType::vector3,
                     .rgb = graph.emit(NodeOp::position, {node_constant(world)}, at.node.loc),
                     .source = &at.node};
}

std::optional<MtlxValue> read_direction(MtlxGraph& graph, const At& at) {
    MtlxValue out{.type = MtlxType::vector3, .source = &at.node};
    const bool view = at.node.category == "viewdirection";
    const std::string space = graph.text(at, "space", view ? "world" : "object");
    if (space != "world") {
        graph.damage(at, "space is '" + space + "', only 'world' is here");
        return std::nullopt;
    }
    if (view) {
        out.rgb = graph.emit(NodeOp::viewdirection, {}, at.node.loc);
        return out;
    }
    out.kind = at.node.category == "normal" ? Kind::surface_normal : Kind::surface_tangent;
    const NodeOp op = at.node.category == "normal" ? NodeOp::normal : NodeOp::tangent;
    out.rgb = graph.emit(op, {}, at.node.loc);
    return out;
}

struct Special {
    std::string_view category;
    std::optional<MtlxValue> (*read)(MtlxGraph&, const At&);
};
constexpr std::array<Special, 9> kSpecial{{{"constant", read_constant},
                                           {"position", read_position},
                                           {"normal", read_direction},
                                           {"tangent", read_direction},
                                           {"viewdirection", read_direction},
                                           {"image", read_mtlx_image},
                                           {"tiledimage", read_mtlx_image},
                                           {"triplanarprojection", read_mtlx_triplanar},
                                           {"normalmap", read_mtlx_normal_map}}};

std::string nearest_nodes(const std::string& category) {
    std::vector<std::string> names;
    for (const NodeInfo& info : kNodes) names.emplace_back(info.name);
    for (const Special& special : kSpecial) names.emplace_back(special.category);
    for (const std::string_view name : mtlx_rewritten_nodes()) names.emplace_back(name);
    return did_you_mean(category, names);
}

}  // namespace

std::optional<MtlxValue> read_mtlx_node(MtlxGraph& graph, const At& at) {
    const std::string& category = at.node.category;
    for (const Special& special : kSpecial)
        if (special.category == category) return special.read(graph, at);
    if (is_mtlx_rewritten(category)) return read_mtlx_rewritten(graph, at);
    const int index = find_node(category);
    if (index >= 0) return TableNode(graph, at, kNodes[static_cast<std::size_t>(index)]).read();
    graph.damage(at, "node '" + category + "' is not read" + nearest_nodes(category));
    return std::nullopt;
}

}  // namespace tessera
