#include "renderer/cli/snapshots.h"

#include <exception>
#include <memory>
#include <system_error>

#include <fmt/format.h>

namespace tessera {

Snapshots::Snapshots(Write write, ProgressPrinter& printer)
    : write_(std::move(write)), printer_(printer) {}

Snapshots::~Snapshots() {
    if (thread_.joinable()) thread_.join();
}

void Snapshots::start(RenderResult&& picture) {
    if (thread_.joinable()) thread_.join();
    const auto owned = std::make_shared<RenderResult>(std::move(picture));
    try {
        thread_ = std::thread([this, owned] { write(*owned); });
    } catch (const std::system_error&) {
        write(*owned);  // no thread to be had: the render waits
    }
}

void Snapshots::write(RenderResult& picture) noexcept {
    try {
        write_(picture);
        printer_.info(fmt::format("snapshot written after {:.3g} s", picture.stats.render_s));
    } catch (const std::exception& error) {
        printer_.warn(std::string("snapshot: ") + error.what());
    }
}

}  // namespace tessera
