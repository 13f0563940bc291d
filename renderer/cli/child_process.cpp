#include "renderer/cli/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "renderer/api/error.h"

namespace tessera {
namespace {

constexpr int kPollMs = 10;

// A file without a name: what the child prints never waits for a reader.
class Captured {
public:
    Captured() : file_(::memfd_create("captured", MFD_CLOEXEC)) {
        if (file_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
    }
    ~Captured() { ::close(file_); }
    Captured(const Captured&) = delete;
    Captured& operator=(const Captured&) = delete;

    int file() const noexcept { return file_; }
    std::string text() const {
        std::string out;
        std::array<char, 4096> part{};
        while (true) {
            const ssize_t n =
                ::pread(file_, part.data(), part.size(), static_cast<off_t>(out.size()));
            if (n <= 0) return out;
            out.append(part.data(), static_cast<std::size_t>(n));
        }
    }

private:
    int file_;
};

// Between fork and exec: nothing that takes a lock or memory.
[[noreturn]] void become(char* const* arguments, int out, int err, int failure, pid_t parent) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    const int null = ::open("/dev/null", O_RDONLY);
    const bool ready = ::getppid() == parent && null >= 0 && ::dup2(null, STDIN_FILENO) >= 0 &&
                       ::dup2(out, STDOUT_FILENO) >= 0 && ::dup2(err, STDERR_FILENO) >= 0;
    if (ready) ::execvp(arguments[0], arguments);
    const int why = errno;
    if (::write(failure, &why, sizeof why) < 0) ::_exit(126);
    ::_exit(127);
}

int wait_for(pid_t child, const std::atomic<bool>& stop) {
    bool told = false;
    int status = 0;
    while (true) {
        const pid_t done = ::waitpid(child, &status, WNOHANG);
        if (done == child) break;
        if (done < 0 && errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "waitpid");
        if (stop && !told) {
            ::kill(child, SIGINT);
            told = true;
        }
        ::poll(nullptr, 0, kPollMs);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ChildResult run_child(const std::vector<std::string>& arguments, const std::atomic<bool>& stop) {
    const Captured out, err;
    std::vector<std::string> words = arguments;
    std::vector<char*> pointers;
    for (std::string& w : words) pointers.push_back(w.data());
    pointers.push_back(nullptr);
    std::array<int, 2> failure{};  // says why exec failed; closed by it otherwise
    if (::pipe2(failure.data(), O_CLOEXEC) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe2");
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) become(pointers.data(), out.file(), err.file(), failure[1], parent);
    const int no_child = errno;
    ::close(failure[1]);
    if (child < 0) {
        ::close(failure[0]);
        throw std::system_error(no_child, std::generic_category(), "fork");
    }
    int why = 0;
    const bool failed = ::read(failure[0], &why, sizeof why) == sizeof why;
    ::close(failure[0]);
    ChildResult result;
    result.code = wait_for(child, stop);
    if (failed)
        throw Error(ExitCode::usage, arguments[0] + ": cannot be run: " + std::strerror(why));
    result.out = out.text();
    result.err = err.text();
    return result;
}

std::string own_program() {
    std::error_code failed;
    const auto path = std::filesystem::read_symlink("/proc/self/exe", failed);
    if (failed) throw Error(ExitCode::bug, "/proc/self/exe: " + failed.message());
    return path.string();
}

}  // namespace tessera
