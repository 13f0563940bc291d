#pragma once
// Nodes of MaterialX that our table lacks and that others come to exactly. Private to the MaterialX
// reader.

#include "renderer/io/mtlx_graph.h"

namespace tessera {

bool is_mtlx_rewritten(std::string_view category);
std::vector<std::string_view> mtlx_rewritten_nodes();
std::optional<MtlxValue> read_mtlx_rewritten(MtlxGraph& graph, const MtlxGraph::NodeAt& at);

}  // namespace tessera
