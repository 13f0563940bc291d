#pragma once
// docs/nodes.md from the table of nodes.

#include <string>

namespace tessera {

std::string nodes_markdown();

}  // namespace tessera
