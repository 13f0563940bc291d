#pragma once
// One node of MaterialX on its way to be others. Private to the MaterialX reader.

#include <initializer_list>
#include <vector>

#include "renderer/io/mtlx_graph.h"

namespace tessera {

/// One node being rewritten.
struct MtlxRewrite {
    MtlxGraph& graph;
    const MtlxGraph::NodeAt& at;
    bool good = true;

    static inline const NodeValue kOne{{1, 1, 1}}, kZero{{0, 0, 0}};

    /// An input, or what it is by default; of the node's type or a number.
    MtlxValue in(std::string_view name, float otherwise = 0) {
        if (const MtlxElement* element = at.node.child(name)) {
            if (const auto value = graph.value_of(*element, at.scope)) return *value;
            good = false;
        }
        return {.type = at.type,
                .rgb = node_constant(otherwise),
                .fourth = node_constant(otherwise),
                .source = &at.node};
    }
    MtlxValue matching(std::string_view name, float otherwise = 0) {
        MtlxValue value = in(name, otherwise);
        if (value.type == at.type || is_number(value.type)) return value;
        mismatch(name, value);
        return value;
    }
    void mismatch(std::string_view name, const MtlxValue& value) {
        graph.damage(at, std::string(name) + " is of type " + std::string(name_of(value.type)) +
                             ", which does not go there");
        good = false;
    }
    NodeValue emit(NodeOp op, std::initializer_list<NodeValue> inputs) {
        return graph.emit(op, inputs, at.node.loc);
    }
    MtlxValue out(const NodeValue& rgb) {
        return {.type = at.type, .rgb = rgb, .source = &at.node};
    }
    /// The same made of the first three components and of the fourth.
    template <class Make>
    MtlxValue each(std::initializer_list<MtlxValue> in, Make make) {
        std::vector<NodeValue> values;
        for (const MtlxValue& v : in) values.push_back(v.rgb);
        MtlxValue result = out(make(values));
        if (!has_fourth(at.type)) return result;
        std::size_t i = 0;
        for (const MtlxValue& v : in) values[i++] = has_fourth(v.type) ? v.fourth : v.rgb;
        result.fourth = make(values);
        return result;
    }
};

/// Noise of any type: numbers, or components that are independent of each other.
std::optional<MtlxValue> rewrite_noise(MtlxRewrite& r);
/// Distances to scattered points; of several components those to the nearest in their order.
std::optional<MtlxValue> rewrite_worley(MtlxRewrite& r);

}  // namespace tessera
