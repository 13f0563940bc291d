#pragma once
// Progress on stderr: a bar on a terminal, plain lines that farm managers can parse otherwise.

#include <mutex>
#include <string>

#include "renderer/api/render.h"

namespace tessera {

class ProgressPrinter {
public:
    /// enabled false: prints nothing.
    explicit ProgressPrinter(bool enabled);
    void show(const Progress& p);
    /// A warning, a line of the log: on lines of their own, from any thread.
    void warn(const std::string& text);
    void info(const std::string& text);
    /// Ends the bar's line, so that what follows starts on its own.
    void finish();

private:
    void bar(const Progress& p);
    void line(const Progress& p);
    void end_bar();

    std::mutex mutex_;
    bool enabled_, terminal_, open_ = false;
    double last_time_ = -1e9, last_fraction_ = -1;
};

/// Peak resident memory of this process, bytes.
std::uint64_t peak_memory();

}  // namespace tessera
