#pragma once
// A file that appears whole or not at all: written as `.<name>.tmp.<pid>` beside its target, then
// renamed. A link as target stays, what it leads to is replaced.

#include <cstddef>
#include <cstdint>
#include <string>

namespace tessera {

/// Throws Error(ExitCode::output): "out/x.exr: cannot write: reason".
[[noreturn]] void fail_output(const std::string& path, const std::string& reason);

/// Every failure throws Error(ExitCode::output) naming the target. A process that wants messages
/// rather than a signal at a file-size limit must ignore SIGXFSZ. One writer per target and process
/// at a time.
class AtomicFile {
public:
    /// Removes temporaries that dead processes left for this target, then creates ours.
    explicit AtomicFile(const std::string& target);
    /// Removes the temporary unless commit() succeeded.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* data, std::size_t bytes);
    void seek(std::uint64_t position);
    std::uint64_t position() const noexcept { return position_; }

    /// Flushes to the disk and closes; returns the size. temp_path() may then be read back.
    std::uint64_t finish();
    /// Renames over the target and flushes the folder. After finish(). Fails if a process of the
    /// same pid (in another container) has taken the temporary's name meanwhile.
    void commit();

    const std::string& target() const noexcept { return target_; }
    const std::string& temp_path() const noexcept { return temp_; }

private:
    std::string target_;
    std::string real_;  // where a link leads; the target otherwise
    std::string folder_;
    std::string temp_;
    int fd_ = -1;
    std::uint64_t position_ = 0;
    std::string identity_;  // of the temporary, once it is finished
    std::string failure_;   // the first one; a later call must not look like success
};

}  // namespace tessera
