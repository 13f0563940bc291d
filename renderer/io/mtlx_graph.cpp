#include "renderer/io/mtlx_graph.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/nearest_name.h"

namespace tessera {
namespace {

constexpr int kMaxDepth = 512;
constexpr std::size_t kMaxNodes = 4096, kMaxNodesOfAll = 1'000'000;
constexpr std::size_t kMaxSuggested = 1000;  // names that a mistyped one is compared with

std::vector<std::string> names_in(const MtlxElement* graph, const MtlxDocument& document) {
    std::vector<std::string> names;
    for (const MtlxElement* one : graph ? graph->children : document.top())
        if (names.size() < kMaxSuggested && one->category != "input" && one->category != "output" &&
            !one->name().empty())
            names.push_back(one->name());
    return names;
}

/// The type of an element; that of a number where none is written.
MtlxType type_of(const MtlxElement& element) {
    const std::string* type = element.find("type");
    return type ? mtlx_type(*type) : MtlxType::scalar;
}

}  // namespace

void MtlxReading::damage(const SourceLoc& loc, const std::string& message) {
    if (said.insert(to_string(loc) + message).second) reader.problems.damage(loc, message);
}

NodeDesc make_node(NodeOp op, const SourceLoc& loc) {
    NodeDesc node;
    node.type = static_cast<int>(op);
    node.loc = loc;
    const std::size_t count = kNodes[static_cast<std::size_t>(op)].inputs().size();
    node.inputs.resize(count);
    node.given.assign(count, false);
    return node;
}

int MtlxGraph::push(NodeDesc node) {
    if (material_.nodes.size() >= kMaxNodes)
        throw Error(ExitCode::scene, node.loc,
                    "material '" + material_.name + "': its graph has more than 4096 nodes");
    if (++reading_.nodes > kMaxNodesOfAll)
        throw Error(ExitCode::scene, node.loc,
                    "the graphs of its materials have more than a million nodes in all");
    material_.nodes.push_back(std::move(node));
    return static_cast<int>(material_.nodes.size()) - 1;
}

NodeValue MtlxGraph::emit(NodeOp op, std::initializer_list<NodeValue> inputs,
                          const SourceLoc& loc) {
    NodeDesc node = make_node(op, loc);
    std::size_t i = 0;
    for (const NodeValue& value : inputs) {
        node.inputs[i] = value;
        node.given[i++] = true;
    }
    return {{}, push(std::move(node))};
}

NodeValue MtlxGraph::product(const NodeValue& value, float factor, const SourceLoc& loc) {
    if (value.node >= 0) return emit(NodeOp::multiply, {value, node_constant(factor)}, loc);
    return {{value.value[0] * factor, value.value[1] * factor, value.value[2] * factor}};
}

std::optional<MtlxValue> MtlxGraph::value_of(const MtlxElement& element, const Scope& scope) {
    const auto [place, is_new] = open_.insert({&element, &scope});
    if (!is_new) {
        damage(element.loc, element.subject() + ": goes in a circle");
        return std::nullopt;
    }
    std::optional<MtlxValue> value;
    if (depth_ >= kMaxDepth) {
        damage(element.loc, element.subject() + ": nodes behind nodes deeper than 512");
    } else {
        ++depth_;
        value = follow(element, scope);
        --depth_;
    }
    open_.erase(place);
    if (!value) return value;
    const MtlxType wanted = type_of(element);
    if (element.find("type") && value->type != wanted) {
        damage(element.loc, element.subject() + ": is of type " + std::string(name_of(wanted)) +
                                ", what it is given of type " + std::string(name_of(value->type)) +
                                " (see 'convert', 'extract')");
        return std::nullopt;
    }
    return value;
}

std::optional<MtlxValue> MtlxGraph::follow(const MtlxElement& element, const Scope& scope) {
    if (const std::string* unit = element.find("unit"))
        reading_.reader.problems.warn(element.loc,
                                      element.subject() + ": unit '" + *unit +
                                          "' is not applied: lengths are scene units, angles "
                                          "degrees");
    if (const std::string* name = element.find("interfacename"); name && !name->empty())
        return from_interface(element, scope, *name);
    if (const std::string* name = element.find("nodegraph"); name && !name->empty())
        return from_graph(element, *name, scope);
    if (const std::string* name = element.find("nodename"); name && !name->empty())
        return from_node(element, *name, scope);
    if (const std::string* value = element.find("value"); value && !value->empty())
        return written(element, type_of(element));
    const std::string* name = element.find("output");
    if (name && !name->empty() && element.category == "input") {
        const MtlxElement* target = reading_.document.find(*name);
        if (target && target->category == "output") return value_of(*target, root_);
        damage(element.loc, element.subject() + ": there is no output '" + *name + "'");
        return std::nullopt;
    }
    if (const std::string* geometry = element.find("defaultgeomprop"))
        return from_geometry(element, *geometry);
    const MtlxType type = type_of(element);
    if (type == MtlxType::string || type == MtlxType::filename) return written(element, type);
    return std::nullopt;
}

std::optional<MtlxValue> MtlxGraph::written(const MtlxElement& element, MtlxType type) {
    const std::string* value = element.find("value");
    const std::string text = value ? *value : "";
    MtlxValue out{.type = type, .source = &element};
    const auto misfit = [&] {
        damage(element.loc, element.subject() + ": value is '" + text + "', must be of type " +
                                std::string(name_of(type)));
        return std::nullopt;
    };
    if (type == MtlxType::string || type == MtlxType::filename) {
        out.text = text;
        return out;
    }
    if (type == MtlxType::boolean) {
        if (text != "true" && text != "false") return misfit();
        out.rgb = node_constant(text == "true" ? 1.0f : 0.0f);
        return out;
    }
    const auto numbers = mtlx_numbers(text);
    const auto width = static_cast<std::size_t>(width_of(type));
    if (width == 0) {
        const std::string* name = element.find("type");
        damage(element.loc, element.subject() + ": type '" + (name ? *name : "") + "' is not read");
        return std::nullopt;
    }
    if (!numbers || numbers->size() != width) return misfit();
    if (type == MtlxType::integer && (*numbers)[0] != std::floor((*numbers)[0])) return misfit();
    for (std::size_t i = 0; i < 3; ++i)
        out.rgb.value[i] = width == 1 ? (*numbers)[0] : (i < width ? (*numbers)[i] : 0.0f);
    if (width == 4) out.fourth = node_constant((*numbers)[3]);
    if (is_color(type)) {
        try {
            reading_.colors.to_working(out.rgb.value, mtlx_color_space(element));
        } catch (const Error& error) {
            damage(element.loc, element.subject() + ": " + error.what());
        }
    }
    return out;
}

std::optional<MtlxValue> MtlxGraph::from_interface(const MtlxElement& element, const Scope& scope,
                                                   const std::string& name) {
    if (scope.instance)
        if (const MtlxElement* given = scope.instance->child(name))
            return value_of(*given, *scope.outer);
    if (scope.graph) {
        if (const MtlxElement* own = scope.graph->child(name); own && own->category == "input")
            return value_of(*own, root_);
        const std::string* definition = scope.graph->find("nodedef");
        const MtlxElement* defined = definition ? reading_.document.find(*definition) : nullptr;
        if (defined && defined->child(name)) return value_of(*defined->child(name), root_);
    }
    if (element.find("value")) return written(element, type_of(element));
    damage(element.loc,
           element.subject() + ": what it stands in has no input '" + name + "' to take it from");
    return std::nullopt;
}

std::optional<MtlxValue> MtlxGraph::from_graph(const MtlxElement& element, const std::string& name,
                                               const Scope& scope) {
    const MtlxElement* graph = find(scope, name);
    if (!graph) graph = reading_.document.find(name);
    if (!graph || graph->category != "nodegraph") {
        std::vector<std::string> names;
        for (const MtlxElement* one : reading_.document.top())
            if (names.size() < kMaxSuggested && one->category == "nodegraph")
                names.push_back(one->name());
        damage(element.loc, element.subject() + ": there is no nodegraph '" + name + "'" +
                                did_you_mean(name, names));
        return std::nullopt;
    }
    const MtlxElement* output = output_of(*graph, element.find("output"), element);
    const Scope* inner = output ? scope_of(*graph, nullptr, root_) : nullptr;
    return inner ? value_of(*output, *inner) : std::nullopt;
}

const MtlxElement* MtlxGraph::output_of(const MtlxElement& graph, const std::string* name,
                                        const MtlxElement& from) {
    std::vector<std::string> names;
    const MtlxElement* found = nullptr;
    for (const MtlxElement* one : graph.children) {
        if (one->category != "output") continue;
        names.push_back(one->name());
        if (!name || one->name() == *name) found = one;
    }
    if (found && (name || names.size() == 1)) return found;
    damage(from.loc,
           from.subject() + ": " + graph.subject() +
               (name ? " has no output '" + *name + "'" + did_you_mean(*name, names)
                     : " has " + std::to_string(names.size()) + " outputs, say which: output="));
    return nullptr;
}

std::optional<MtlxValue> MtlxGraph::from_geometry(const MtlxElement& element,
                                                  const std::string& name) {
    MtlxValue out{.type = type_of(element), .source = &element};
    if (name == "UV0") {
        out.rgb = emit(NodeOp::texcoord, {}, element.loc);
    } else if (name == "Pobject" || name == "Pworld") {
        out.rgb = emit(NodeOp::position, {node_constant(name == "Pworld" ? 1 : 0)}, element.loc);
    } else if (name == "Nworld") {
        out.rgb = emit(NodeOp::normal, {}, element.loc);
        out.kind = MtlxValue::Kind::surface_normal;
    } else if (name == "Tworld") {
        out.rgb = emit(NodeOp::tangent, {}, element.loc);
        out.kind = MtlxValue::Kind::surface_tangent;
    } else {
        damage(element.loc, element.subject() + ": defaultgeomprop '" + name +
                                "' is not read (UV0, Pobject, Pworld, Nworld, Tworld are)");
        return std::nullopt;
    }
    return out;
}

const MtlxElement* MtlxGraph::find(const Scope& scope, const std::string& name) const {
    return scope.graph ? scope.graph->child(name) : reading_.document.find(name);
}

std::optional<MtlxValue> MtlxGraph::from_node(const MtlxElement& element, const std::string& name,
                                              const Scope& scope) {
    const MtlxElement* node = find(scope, name);
    if (node && node->category == "nodegraph") return from_graph(element, name, scope);
    if (!node || node->category == "input" || node->category == "output") {
        damage(element.loc, element.subject() + ": there is no node '" + name + "'" +
                                did_you_mean(name, names_in(scope.graph, reading_.document)));
        return std::nullopt;
    }
    const std::string* output = element.find("output");
    const NodeAt at{*node, scope, type_of(*node), output ? *output : ""};
    const auto key = std::make_tuple(node, &scope, at.output);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    std::optional<MtlxValue> value;
    const MtlxElement* definition = nullptr;
    const std::string* wanted = node->find("nodedef");
    const auto [first, last] = reading_.definitions.equal_range(node->category);
    for (auto one = first; one != last; ++one)
        if (!wanted || *wanted == one->second->name()) definition = one->second;
    value = definition ? custom_node(at, *definition) : read_mtlx_node(*this, at);
    known_[key] = value;
    return value;
}

std::optional<MtlxValue> MtlxGraph::custom_node(const NodeAt& at, const MtlxElement& definition) {
    const MtlxElement* graph = nullptr;
    for (const MtlxElement* one : reading_.document.top()) {
        const std::string* implemented = one->find("nodedef");
        if (!implemented || *implemented != definition.name()) continue;
        if (one->category == "nodegraph") graph = one;
        const std::string* named = one->find("nodegraph");
        if (one->category == "implementation" && named) graph = reading_.document.find(*named);
    }
    if (!graph || graph->category != "nodegraph") {
        damage(at, "no nodegraph makes up nodedef '" + definition.name() + "'");
        return std::nullopt;
    }
    for (const MtlxElement* given : at.node.children) {
        if (given->category != "input" || definition.child(given->name())) continue;
        std::vector<std::string> names;
        for (const MtlxElement* one : definition.children)
            if (one->category == "input") names.push_back(one->name());
        damage(given->loc, at.node.subject() + ": has no input '" + given->name() + "'" +
                               did_you_mean(given->name(), names));
    }
    const MtlxElement* output =
        output_of(*graph, at.output.empty() ? nullptr : &at.output, at.node);
    const Scope* inner = output ? scope_of(*graph, &at.node, at.scope) : nullptr;
    return inner ? value_of(*output, *inner) : std::nullopt;
}

const MtlxGraph::Scope* MtlxGraph::scope_of(const MtlxElement& graph, const MtlxElement* instance,
                                            const Scope& outer) {
    for (const Scope* at = &outer; at && instance; at = at->outer) {
        if (at->graph != &graph) continue;
        damage(instance->loc, instance->subject() + ": goes in a circle");
        return nullptr;
    }
    const auto [known, is_new] = known_scopes_.try_emplace({&graph, instance, &outer}, nullptr);
    if (is_new) known->second = &scopes_.emplace_back(Scope{&graph, instance, &outer});
    if (scopes_.size() > kMaxNodes)
        throw Error(ExitCode::scene, graph.loc,
                    "material '" + material_.name + "': more than 4096 graphs in its graphs");
    return known->second;
}

std::optional<MtlxValue> MtlxGraph::input(const NodeAt& at, std::string_view name) {
    const MtlxElement* element = at.node.child(name);
    if (!element || element->category != "input") return std::nullopt;
    return value_of(*element, at.scope);
}

float MtlxGraph::number(const NodeAt& at, std::string_view name, float otherwise) {
    const auto value = input(at, name);
    if (!value) return otherwise;
    if (value->is_constant() && is_number(value->type)) return value->rgb.value[0];
    damage(at, std::string(name) + " must be a written number");
    return otherwise;
}

std::string MtlxGraph::text(const NodeAt& at, std::string_view name, const std::string& otherwise) {
    const auto value = input(at, name);
    if (!value) return otherwise;
    if (value->type == MtlxType::string || value->type == MtlxType::filename) return value->text;
    damage(at, std::string(name) + " must be a text");
    return otherwise;
}

std::optional<MtlxGraph::NodeAt> MtlxGraph::shader(const MtlxElement& input, const Scope& scope) {
    const std::string* graph_name = input.find("nodegraph");
    const std::string* node_name = input.find("nodename");
    if (graph_name && !graph_name->empty()) {
        const MtlxElement* graph = reading_.document.find(*graph_name);
        if (graph && graph->category == "nodegraph" && !scope.graph) {
            const MtlxElement* output = output_of(*graph, input.find("output"), input);
            const Scope* inner = output ? scope_of(*graph, nullptr, root_) : nullptr;
            return inner ? shader(*output, *inner) : std::nullopt;
        }
    } else if (node_name && !node_name->empty()) {
        if (const MtlxElement* node = find(scope, *node_name))
            return NodeAt{*node, scope, MtlxType::other};
    }
    const std::string* wanted = graph_name ? graph_name : node_name;
    damage(input.loc,
           input.subject() + ": " +
               (wanted ? "there is no '" + *wanted + "'" +
                             did_you_mean(*wanted, names_in(scope.graph, reading_.document))
                       : "is given no shader"));
    return std::nullopt;
}

}  // namespace tessera
