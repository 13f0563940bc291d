// MaterialX's noises, which come in more types than those of our table.

#include "renderer/io/mtlx_rewrite.h"

namespace tessera {
namespace {

/// A node of the table with what it is given by name, but for amplitude and pivot.
NodeDesc placed_node(MtlxRewrite& r, const NodeInfo& info) {
    NodeDesc desc = make_node(info.op, r.at.node.loc);
    const auto inputs = info.inputs();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const std::string_view name = inputs[i].name;
        if (!r.at.node.child(name) || name == "amplitude" || name == "pivot") continue;
        const MtlxValue value = r.in(name);
        const bool plane = name == "texcoord", space = name == "position";
        const bool fits = plane   ? value.type == MtlxType::vector2
                          : space ? value.type == MtlxType::vector3
                                  : is_number(value.type);
        if (!fits) r.mismatch(name, value);
        desc.inputs[i] = value.rgb;
        desc.given[i] = true;
    }
    return desc;
}

std::size_t input_index(const NodeInfo& info, std::string_view name) {
    const auto inputs = info.inputs();
    std::size_t i = 0;
    while (i < inputs.size() && inputs[i].name != name) ++i;
    return i;
}

/// Where noise is asked for, moved: for a component that is independent of the others.
void move_place(MtlxRewrite& r, NodeDesc& desc, const NodeInfo& info) {
    const bool plane = input_index(info, "texcoord") < info.inputs().size();
    const std::size_t i = input_index(info, plane ? "texcoord" : "position");
    NodeValue place = desc.inputs[i];
    if (!desc.given[i])
        place =
            plane ? r.emit(NodeOp::texcoord, {}) : r.emit(NodeOp::position, {MtlxRewrite::kZero});
    desc.inputs[i] = r.emit(NodeOp::add, {place, {{19, 73, plane ? 0.0f : 29.0f}}});
    desc.given[i] = true;
}

}  // namespace

std::optional<MtlxValue> rewrite_noise(MtlxRewrite& r) {
    const NodeInfo& info = kNodes[static_cast<std::size_t>(find_node(r.at.node.category))];
    constexpr int kColor = 1;
    const int width = width_of(r.at.type);
    if (width == 0) {
        r.graph.damage(r.at, "does not come in that type");
        return std::nullopt;
    }
    const NodeDesc desc = placed_node(r, info);
    const auto of_width = [&](std::string_view name, float otherwise) {
        const MtlxValue value = r.in(name, otherwise);
        if (!is_number(value.type) && width_of(value.type) != width) r.mismatch(name, value);
        return value;
    };
    const MtlxValue amplitude = of_width("amplitude", 1), pivot = of_width("pivot", 0);
    if (!r.good) return std::nullopt;
    const auto finished = [&](NodeValue x, const NodeValue& by, const NodeValue& about) {
        if (by != MtlxRewrite::kOne) x = r.emit(NodeOp::multiply, {x, by});
        return about != MtlxRewrite::kZero ? r.emit(NodeOp::add, {x, about}) : x;
    };
    const NodeValue raw{{}, r.graph.push(desc), width == 1 ? 0 : kColor};
    MtlxValue out = r.out(finished(raw, amplitude.rgb, pivot.rgb));
    if (width == 2) out.rgb = r.emit(NodeOp::multiply, {out.rgb, {{1, 1, 0}}});
    if (has_fourth(r.at.type)) {
        NodeDesc moved = desc;
        move_place(r, moved, info);
        const auto fourth = [](const MtlxValue& v) {
            return has_fourth(v.type) ? v.fourth : v.rgb;
        };
        out.fourth = finished({{}, r.graph.push(moved)}, fourth(amplitude), fourth(pivot));
    }
    return out;
}

std::optional<MtlxValue> rewrite_worley(MtlxRewrite& r) {
    const NodeInfo& info = kNodes[static_cast<std::size_t>(find_node(r.at.node.category))];
    const bool cells = r.graph.number(r.at, "style", 0) != 0;
    const int width = width_of(r.at.type);
    const int most = cells ? 1 : 3;
    if (width < 1 || width > most || is_color(r.at.type)) {
        r.graph.damage(r.at, std::string("does not come in that type") +
                                 (cells ? ", of style 1 but as a float" : ""));
        return std::nullopt;
    }
    const NodeDesc desc = placed_node(r, info);
    if (!r.good) return std::nullopt;
    const auto output = [&](std::string_view name) {
        int k = 0;
        for (const NodeOutputInfo& o : info.outputs())
            if (++k, o.name == name) return k;
        return 0;
    };
    const int node = r.graph.push(desc);
    if (width == 1) return r.out({{}, node, cells ? output("cell") : 0});
    const NodeValue all{{}, node, output("distances")};
    return r.out(width == 3 ? all : r.emit(NodeOp::multiply, {all, {{1, 1, 0}}}));
}

}  // namespace tessera
