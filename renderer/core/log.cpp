#include "renderer/core/log.h"

#include <atomic>
#include <cstdio>

namespace tessera {
namespace {

std::atomic<int> g_level{
    static_cast<int>(LogLevel::normal)};  // the one process-wide setting: a sink, not data

void put(const char* prefix, const std::string& line) {
    const std::string text = prefix + line + "\n";
    std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace

void set_log_level(LogLevel level) noexcept { g_level.store(static_cast<int>(level)); }
LogLevel log_level() noexcept { return static_cast<LogLevel>(g_level.load()); }

void log_info(const std::string& line) {
    if (log_level() >= LogLevel::normal) put("", line);
}

void log_verbose(const std::string& line) {
    if (log_level() >= LogLevel::verbose) put("", line);
}

void log_warning(const std::string& line) { put("warning: ", line); }

}  // namespace tessera
