#pragma once
// SIGUSR1 asks for a snapshot. SIGINT, SIGTERM and SIGHUP: Before the render there is nothing to
// save, so they end the program at once with 128 + number; during it they ask the tiles to stop; a
// second one ends it at once. Call in one thread.

#include <atomic>

namespace tessera {

/// Installs the handlers. A signal that was ignored (nohup) stays ignored.
void catch_signals();

/// From here on the first signal sets the flag that is returned instead of ending the program.
const std::atomic<bool>& stop_at_next_tile();

/// Set by SIGUSR1; whoever answers it clears it.
std::atomic<bool>& snapshot_wanted();

/// 128 + the number of the signal that arrived, or 0.
int signal_exit_code();

}  // namespace tessera
