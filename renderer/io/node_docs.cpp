#include "renderer/io/node_docs.h"

#include "renderer/api/node_table.h"
#include "renderer/io/params.h"

#include <fmt/format.h>

namespace tessera {
namespace {

std::string initial_of(const NodeInfo& node, const NodeInputInfo& input) {
    if (input.name == "texcoord") return "the surface's";
    if (input.name == "position") return "the object's";
    if (input.name == "normal" || input.name == "viewdirection") return "the surface's";
    if (node.op == NodeOp::random && input.name == "by") return "'instance'";
    if (node.op == NodeOp::named) return input.name == "by" ? "'object'" : "''";
    const auto number = [](float v) { return params::json(static_cast<double>(v)); };
    const auto& v = input.initial;
    const bool one = input.type == NodeType::scalar || (v[0] == v[1] && v[1] == v[2]);
    if (one) return number(v[0]);
    std::string list = "[" + number(v[0]) + ", " + number(v[1]);
    return list + (input.type == NodeType::vector2 ? "]" : ", " + number(v[2]) + "]");
}

}  // namespace

std::string nodes_markdown() {
    std::string text =
        "# Nodes of shader graphs\n\n"
        "Written by `tessera schema --nodes` from `renderer/api/node_table.h`; how nodes are "
        "written in a "
        "scene\nstands in [scene-format.md](scene-format.md#shader-graphs). Names, inputs and "
        "defaults are "
        "MaterialX's where it has the node.\n\n"
        "![the patterns, by name](patterns.png)\n\n"
        "| node | gives | inputs (default) | what it does |\n|---|---|---|---|\n";
    for (const NodeInfo& node : kNodes) {
        std::string outputs(name_of(node.output));
        for (const NodeOutputInfo& o : node.outputs()) {
            outputs += ", `" + std::string(o.name) + "`";
            if (o.type != NodeType::scalar) outputs += " (" + std::string(name_of(o.type)) + ")";
        }
        std::string inputs;
        for (const NodeInputInfo& i : node.inputs())
            inputs += (inputs.empty() ? "`" : ", `") + std::string(i.name) + "` (" +
                      initial_of(node, i) + ")";
        text += fmt::format("| `{}` | {} | {} | {} |\n", node.name, outputs, inputs, node.help);
    }
    return text;
}

}  // namespace tessera
