#pragma once
// Another program, run to its end.

#include <atomic>
#include <string>
#include <vector>

namespace tessera {

struct ChildResult {
    int code = 0;  // 128 + the signal that ended it
    std::string out, err;
};

/// In a process group of its own, so that Ctrl-C does not reach it but through `stop`: once that is
/// set it gets one SIGINT. It ends when this process does. Throws Error(usage) if it cannot be
/// started.
ChildResult run_child(const std::vector<std::string>& arguments, const std::atomic<bool>& stop);

/// The file of this very program.
std::string own_program();

}  // namespace tessera
