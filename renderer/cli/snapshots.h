#pragma once
// Pictures of a render that goes on, written by a thread of their own.

#include <functional>
#include <string>
#include <thread>

#include "renderer/api/render.h"
#include "renderer/cli/progress.h"

namespace tessera {

class Snapshots {
public:
    /// Writes the files of a picture; throws Error.
    using Write = std::function<WriteReport(RenderResult&)>;

    /// What cannot be written is a warning through the printer.
    Snapshots(Write write, ProgressPrinter& printer);
    /// Waits for the one under way: nobody else may write to the same file before.
    ~Snapshots();
    Snapshots(const Snapshots&) = delete;
    Snapshots& operator=(const Snapshots&) = delete;

    /// Waits for the one before.
    void start(RenderResult&& picture);

private:
    void write(RenderResult& picture) noexcept;

    Write write_;
    ProgressPrinter& printer_;
    std::thread thread_;
};

}  // namespace tessera
