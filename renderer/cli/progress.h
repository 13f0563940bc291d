#pragma once
// Progress on stderr: a bar on a terminal, plain lines that farm managers can parse otherwise.

#include <mutex>
#include <string>
#include <vector>

#include "renderer/api/render.h"

namespace tessera {

enum class ProgressStyle : int {
    automatic,  // bar on a terminal, else line
    bar,
    line,
    json,     // an object a line
    tractor,  // line, and on stdout the lines that Pixar's Tractor looks for
    none,
};

/// The words of --progress, in the order of the styles.
const std::vector<std::string>& progress_styles();

class ProgressPrinter {
public:
    explicit ProgressPrinter(ProgressStyle style);
    void show(const Progress& p);
    /// A warning, a line of the log: on lines of their own, from any thread.
    void warn(const std::string& text);
    void info(const std::string& text);
    /// Ends the bar's line, so that what follows starts on its own.
    void finish();

private:
    void bar(const Progress& p);
    void line(const Progress& p);
    void json(const Progress& p);
    void tractor(const Progress& p);
    void end_bar();

    std::mutex mutex_;
    ProgressStyle style_;
    bool open_ = false;
    double last_time_ = -1e9, last_fraction_ = -1;
};

/// Peak resident memory of this process, bytes.
std::uint64_t peak_memory();

}  // namespace tessera
