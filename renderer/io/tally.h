#pragma once
// Damage, warnings and notes of a kind, the first few located, the rest counted: a broken file of a
// million lines gives a short report.

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "renderer/api/error.h"

namespace tessera {

class Tally {
public:
    Tally(Problems& problems, std::shared_ptr<const std::string> file, int shown = 3)
        : problems_(&problems), file_(std::move(file)), shown_(shown) {}

    /// One more of `kind`; the first few become warnings "file:line: kind detail".
    void add(const char* kind, std::uint32_t line, const std::string& detail = {}) {
        if (++warnings_[kind] <= shown_) problems_->warn(at(line), text(kind, detail));
    }
    /// The same for input that is broken: errors unless lenient.
    void damage(const char* kind, std::uint32_t line, const std::string& detail = {}) {
        if (++damages_[kind] <= shown_) problems_->damage(at(line), text(kind, detail));
    }
    /// The same for notes.
    void note(const char* kind, std::uint32_t line, const std::string& detail = {}) {
        if (++notes_[kind] <= shown_) problems_->note(at(line), text(kind, detail));
    }

    /// Reports how many more there were of each kind.
    void finish() {
        for (const auto& [kind, count] : damages_)
            if (count > shown_) problems_->damage(at(0), more(count, kind));
        for (const auto& [kind, count] : warnings_)
            if (count > shown_) problems_->warn(at(0), more(count, kind));
        for (const auto& [kind, count] : notes_)
            if (count > shown_) problems_->note(at(0), more(count, kind));
        damages_.clear();
        warnings_.clear();
        notes_.clear();
    }

    bool lenient() const noexcept { return problems_->lenient(); }
    const std::shared_ptr<const std::string>& file() const noexcept { return file_; }

private:
    using Counts = std::map<std::string, std::int64_t, std::less<>>;

    SourceLoc at(std::uint32_t line) const { return {file_, static_cast<int>(line), 0}; }
    static std::string text(const char* kind, const std::string& detail) {
        return detail.empty() ? std::string(kind) : std::string(kind) + " " + detail;
    }
    std::string more(std::int64_t count, std::string kind) const {
        if (kind.ends_with(':')) kind.pop_back();
        return std::to_string(count - shown_) + " more: " + kind;
    }

    Problems* problems_;
    std::shared_ptr<const std::string> file_;
    Counts damages_, warnings_, notes_;
    std::int64_t shown_;
};

}  // namespace tessera
