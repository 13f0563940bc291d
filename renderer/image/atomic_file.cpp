#include "renderer/image/atomic_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <vector>

#include "renderer/api/error.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNameKept = 200;

std::string follow(const std::string& path) {
    std::error_code failed;
    if (!fs::is_symlink(path, failed)) return path;
    const fs::path real = fs::weakly_canonical(path, failed);
    return failed ? path : real.string();
}

std::string errno_text(int code) { return std::generic_category().message(code); }

// Inodes are used again at once, but what is half written is smaller. (Times change on network
// disks after closing.)
std::string identity_of(const struct stat& s) {
    return std::to_string(s.st_ino) + " " + std::to_string(s.st_size);
}

bool is_dead(int pid) { return ::kill(pid, 0) != 0 && errno == ESRCH; }

/// Files named prefix + pid whose process is gone.
std::vector<fs::path> leftovers(const fs::path& folder, const std::string& prefix) {
    std::vector<fs::path> found;
    std::error_code ignored;
    for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end;
         it.increment(ignored)) {
        const std::string name = it->path().filename().string();
        if (!name.starts_with(prefix)) continue;
        const char* const last = name.data() + name.size();
        int pid = 0;
        const auto [stop, code] = std::from_chars(name.data() + prefix.size(), last, pid);
        if (code == std::errc() && stop == last && pid > 0 && is_dead(pid))
            found.push_back(it->path());
    }
    return found;
}

}  // namespace

void fail_output(const std::string& path, const std::string& reason) {
    throw Error(ExitCode::output, path + ": cannot write: " + reason);
}

AtomicFile::AtomicFile(const std::string& target) : target_(target), real_(follow(target)) {
    const fs::path path(real_);
    const std::string name = path.filename().string();
    if (name.empty() || name == "." || name == "..") fail_output(target, "not a file name");
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    folder_ = folder.string();

    struct stat info {};
    if (::stat(folder_.c_str(), &info) != 0)
        fail_output(target, "folder '" + folder_ + "': " + errno_text(errno));
    if (!S_ISDIR(info.st_mode)) fail_output(target, "'" + folder_ + "' is not a folder");
    if (::stat(real_.c_str(), &info) != 0) {
        if (errno != ENOENT) fail_output(target, errno_text(errno));
    } else if (!S_ISREG(info.st_mode)) {
        fail_output(target, S_ISDIR(info.st_mode) ? "it is a folder" : "it is not a regular file");
    }

    // The longest name that a file system takes leaves no room for the rest of ours.
    const std::string prefix = "." + name.substr(0, kNameKept) + ".tmp.";
    for (const fs::path& old : leftovers(folder, prefix)) ::unlink(old.c_str());
    temp_ = (folder / (prefix + std::to_string(::getpid()))).string();
    ::unlink(temp_.c_str());  // our pid used by someone before us
    fd_ = ::open(temp_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (fd_ < 0) {
        const int code = errno;
        temp_.clear();
        fail_output(target, errno_text(code));
    }
}

AtomicFile::~AtomicFile() {
    if (fd_ >= 0) ::close(fd_);
    if (!temp_.empty()) ::unlink(temp_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
    if (!failure_.empty()) fail_output(target_, failure_);
    const char* from = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t done = ::pwrite(fd_, from, bytes, static_cast<off_t>(position_));
        if (done < 0 && errno == EINTR) continue;
        if (done <= 0) {
            failure_ = done < 0 ? errno_text(errno) : "the disk took no more data";
            fail_output(target_, failure_);
        }
        from += done;
        bytes -= static_cast<std::size_t>(done);
        position_ += static_cast<std::uint64_t>(done);
    }
}

void AtomicFile::seek(std::uint64_t position) { position_ = position; }

std::uint64_t AtomicFile::finish() {
    if (!failure_.empty()) fail_output(target_, failure_);
    struct stat info {};
    if (::fsync(fd_) != 0 || ::fstat(fd_, &info) != 0) fail_output(target_, errno_text(errno));
    identity_ = identity_of(info);
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0) fail_output(target_, errno_text(errno));
    return static_cast<std::uint64_t>(info.st_size);
}

void AtomicFile::commit() {
    struct stat info {};
    if (::stat(temp_.c_str(), &info) != 0 || identity_of(info) != identity_) {
        temp_.clear();
        fail_output(target_, "another process writes the same file");
    }
    if (::rename(temp_.c_str(), real_.c_str()) != 0) fail_output(target_, errno_text(errno));
    temp_.clear();
    // The file is in place; a file system that cannot flush folders (some network ones) is no
    // failure.
    const int folder = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    ::fsync(folder);
    ::close(folder);
}

}  // namespace tessera
