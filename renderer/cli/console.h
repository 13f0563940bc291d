#pragma once
// The standard streams: opened if the caller closed them, and checked when it matters.

#include <string>

namespace tessera {

/// Opens /dev/null for each of stdin, stdout and stderr that is closed, so that no file of ours
/// gets its number and with it the log.
void open_closed_streams();

/// Writes a command's result to stdout and flushes it. Throws Error(output) if that fails.
void print_out(const std::string& text);

/// Writes to stderr; a failure is ignored, so that a lost terminal never stops a render.
void print_err(const std::string& text);

/// A terminal must not obey what a file calls its layers: control characters become '?'.
std::string printable(std::string text);

}  // namespace tessera
