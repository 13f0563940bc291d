#pragma once
// Errors a caller can show to a person: where, what was wrong, what was expected, what to do.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace tessera {

/// Process exit codes; a farm decides by them whether to retry.
enum class ExitCode : int {
    done = 0,
    bug = 1,
    usage = 2,
    scene = 3,
    output = 4,
    memory = 5,
    differs = 10,
    checkpoint = 75,
};

/// A place in an input file. Line and column count from 1; 0 means unknown.
struct SourceLoc {
    std::shared_ptr<const std::string> file;
    int line = 0;
    int column = 0;
};

/// "file:line:column", as far as known; empty when nothing is.
std::string to_string(const SourceLoc& loc);

/// One or more located problems (at most Problems::kMax). what() is the lines joined by '\n'.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& message);
    Error(ExitCode code, const SourceLoc& loc, const std::string& message);
    ExitCode code() const noexcept { return code_; }

private:
    ExitCode code_;
};

/// How much is put up with in what is read.
enum class Strictness {
    lenient,  // what is broken is left out with a warning
    normal,   // what is broken is an error; what is missing or unclear is a warning
    strict,   // warnings are errors
};

/// Collects located problems so that a user sees many at once rather than the first.
class Problems {
public:
    static constexpr int kMax = 20;

    explicit Problems(Strictness strictness = Strictness::normal) : strictness_(strictness) {}

    /// Records an error; throws Error as soon as kMax are there.
    void error(const SourceLoc& loc, const std::string& message);
    /// Input that is broken: an error, or a warning when lenient.
    void damage(const SourceLoc& loc, const std::string& message);
    /// Records a warning. The same text is kept once.
    void warn(const SourceLoc& loc, const std::string& message);
    /// A remark about what was done in the user's place (never an error). The same text is kept
    /// once.
    void note(const SourceLoc& loc, const std::string& message);
    /// Throws Error(code) with every error collected so far, if there is one.
    void throw_if_any(ExitCode code = ExitCode::scene) const;

    bool lenient() const noexcept { return strictness_ == Strictness::lenient; }
    const std::vector<std::string>& errors() const noexcept { return errors_; }
    const std::vector<std::string>& warnings() const noexcept { return warnings_; }
    const std::vector<std::string>& notes() const noexcept { return notes_; }

private:
    Strictness strictness_;
    bool damaged_ = false;
    std::vector<std::string> errors_;
    std::vector<std::string> warnings_;
    std::vector<std::string> notes_;
};

}  // namespace tessera
