#include "renderer/api/error.h"

#include <algorithm>

namespace tessera {
namespace {

std::string located(const SourceLoc& loc, const std::string& message) {
    const std::string where = to_string(loc);
    return where.empty() ? message : where + ": " + message;
}

void add_once(std::vector<std::string>& lines, std::string line) {
    if (std::find(lines.begin(), lines.end(), line) == lines.end())
        lines.push_back(std::move(line));
}

}  // namespace

std::string to_string(const SourceLoc& loc) {
    std::string text = loc.file ? *loc.file : std::string();
    if (loc.line > 0) text.append(":").append(std::to_string(loc.line));
    if (loc.line > 0 && loc.column > 0) text.append(":").append(std::to_string(loc.column));
    return text;
}

Error::Error(ExitCode code, const std::string& message)
    : std::runtime_error(message), code_(code) {}

Error::Error(ExitCode code, const SourceLoc& loc, const std::string& message)
    : std::runtime_error(located(loc, message)), code_(code) {}

void Problems::error(const SourceLoc& loc, const std::string& message) {
    errors_.push_back(located(loc, message));
    if (errors_.size() >= kMax) throw_if_any();
}

void Problems::damage(const SourceLoc& loc, const std::string& message) {
    if (lenient()) return warn(loc, message);
    damaged_ = true;
    error(loc, message);
}

void Problems::warn(const SourceLoc& loc, const std::string& message) {
    if (strictness_ == Strictness::strict) return error(loc, message);
    add_once(warnings_, located(loc, message));
}

void Problems::note(const SourceLoc& loc, const std::string& message) {
    add_once(notes_, located(loc, message));
}

void Problems::throw_if_any(ExitCode code) const {
    if (errors_.empty()) return;
    std::string text;
    for (const std::string& line : errors_) text += (text.empty() ? "" : "\n") + line;
    if (damaged_) text += "\n(--lenient leaves out what is broken and renders the rest)";
    throw Error(code, text);
}

}  // namespace tessera
