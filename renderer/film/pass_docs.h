#pragma once
// The lists of passes that people read.

#include <string>

namespace tessera {

/// What `tessera render --list-aovs` prints.
std::string list_of_passes();

/// The same as tables for docs/passes.md.
std::string passes_markdown();

}  // namespace tessera
