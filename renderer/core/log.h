#pragma once
// Lines on stderr, one per phase. Never called from the render loop.

#include <string>

namespace tessera {

enum class LogLevel : int { quiet = 0, normal = 1, verbose = 2 };

/// Set once at start; lines above the level are dropped. Thread-safe.
void set_log_level(LogLevel level) noexcept;
LogLevel log_level() noexcept;

/// A line that every run shows (unless quiet).
void log_info(const std::string& line);
/// A line that -v shows.
void log_verbose(const std::string& line);
/// "warning: " + line; shown even when quiet.
void log_warning(const std::string& line);

}  // namespace tessera
