#include "renderer/cli/signals.h"

#include <unistd.h>

#include <csignal>
#include <cstring>

namespace tessera {
namespace {

std::atomic<bool> g_cancel{false};
std::atomic<bool> g_snapshot{false};
std::atomic<bool> g_rendering{false};
std::atomic<int> g_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void on_signal(int number) {
    const bool first = g_signal.exchange(number) == 0;
    if (first && g_rendering.load()) {
        g_cancel.store(true);
        return;
    }
    static constexpr char kStopped[] =
        "stopped by a signal before anything was rendered; nothing saved\n";
    static constexpr char kAtOnce[] = "\nstopped at once by a second signal; nothing saved\n";
    const char* const text = first ? kStopped : kAtOnce;
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) {
        // Nobody listens; the exit code still tells.
    }
    _exit(128 + number);
}

extern "C" void on_snapshot_signal(int /*number*/) { g_snapshot.store(true); }

}  // namespace

void catch_signals() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction old {};
        sigaction(number, nullptr, &old);
        if (old.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
    }
    action.sa_handler = on_snapshot_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGUSR1, &action, nullptr);
}

const std::atomic<bool>& stop_at_next_tile() {
    g_rendering.store(true);
    return g_cancel;
}

std::atomic<bool>& snapshot_wanted() { return g_snapshot; }

int signal_exit_code() {
    const int number = g_signal.load();
    return number == 0 ? 0 : 128 + number;
}

}  // namespace tessera
