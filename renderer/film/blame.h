#pragma once
// Who asked for a pass that cannot be: a line of the scene, or the command line, which has none.

#include "renderer/api/error.h"

namespace tessera {

inline ExitCode blame(const SourceLoc& loc) {
    return loc.line > 0 ? ExitCode::scene : ExitCode::usage;
}

}  // namespace tessera
