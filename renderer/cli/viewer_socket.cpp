#include "renderer/cli/viewer_socket.h"

#include <netdb.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <memory>
#include <system_error>

#include "renderer/api/error.h"

namespace tessera {
namespace {

constexpr std::chrono::milliseconds kConnectTime{3000};
// Small: what lies in it is old, and how it empties tells whether the viewer reads.
constexpr int kSendBuffer = 128 << 10;
constexpr const char* kTevPort = "14158";

std::string errno_text(int code) { return std::generic_category().message(code); }

bool is_port(const std::string& text) {
    int port = 0;
    const char* const last = text.data() + text.size();
    const auto [stop, code] = std::from_chars(text.data(), last, port);
    return code == std::errc() && stop == last && port >= 1 && port <= 65535;
}

[[noreturn]] void fail_address(const std::string& text, const std::string& what) {
    throw Error(ExitCode::usage,
                "--display " + text + ": " + what + "; expected HOST, HOST:PORT or [IPv6]:PORT");
}

}  // namespace

ViewerAddress parse_viewer_address(const std::string& text) {
    ViewerAddress address{text, kTevPort};
    std::size_t colon = text.rfind(':');
    if (text.starts_with('[')) {
        const std::size_t close = text.find(']');
        if (close == std::string::npos) fail_address(text, "']' is missing");
        address.host = text.substr(1, close - 1);
        colon = close + 1 < text.size() ? close + 1 : std::string::npos;
        if (colon != std::string::npos && text[colon] != ':')
            fail_address(text, "after ']' comes ':' and a port");
    } else if (colon != std::string::npos && text.find(':') != colon) {
        colon = std::string::npos;  // a bare IPv6 address
    } else {
        address.host = text.substr(0, colon);
    }
    if (colon != std::string::npos) address.port = text.substr(colon + 1);
    if (address.host.empty()) fail_address(text, "the host is empty");
    if (!is_port(address.port)) fail_address(text, "the port must be in 1..65535");
    return address;
}

Waker::Waker() : fd_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

Waker::~Waker() { ::close(fd_); }

void Waker::wake() noexcept { eventfd_write(fd_, 1); }

void Waker::stop() noexcept {
    stopped_.store(true);
    wake();
}

short Waker::wait(int socket, short events, std::chrono::milliseconds time) noexcept {
    std::array<pollfd, 2> polled{{{socket, events, 0}, {fd_, POLLIN, 0}}};
    if (poll(polled.data(), polled.size(), static_cast<int>(time.count())) <= 0) return 0;
    eventfd_t ignored = 0;
    if (polled[1].revents != 0) eventfd_read(fd_, &ignored);
    return polled[0].revents;
}

ViewerSocket::ViewerSocket(const ViewerAddress& address, Waker& waker) : waker_(waker) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_NUMERICSERV;
    addrinfo* found = nullptr;
    if (const int code = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found))
        throw ViewerLost(code == EAI_SYSTEM ? errno_text(errno) : gai_strerror(code));
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
    std::string why = "no address";
    for (const addrinfo* a = found; a && fd_ < 0; a = a->ai_next) why = connect_to(*a);
    if (fd_ < 0) throw ViewerLost("cannot connect: " + why);
}

ViewerSocket::~ViewerSocket() {
    if (fd_ >= 0) ::close(fd_);
}

// Why it failed; fd_ is set if it did not.
std::string ViewerSocket::connect_to(const addrinfo& address) {
    const int fd = socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC,
                          address.ai_protocol);
    if (fd < 0) return errno_text(errno);
    setsockopt(fd, SOL_SOCKET, SO_SNDBUF, &kSendBuffer, sizeof kSendBuffer);
    int error = connect(fd, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) {
        error = ETIMEDOUT;
        const auto end = std::chrono::steady_clock::now() + kConnectTime;
        for (auto now = std::chrono::steady_clock::now(); now < end && !waker_.stopped();
             now = std::chrono::steady_clock::now()) {
            const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now);
            if (waker_.wait(fd, POLLOUT, left) == 0) continue;
            socklen_t size = sizeof error;
            getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
            break;
        }
    }
    if (error == 0) {
        fd_ = fd;
        return {};
    }
    ::close(fd);
    return errno_text(error);
}

// The viewer says nothing; what can be read is the end of the connection.
void ViewerSocket::check_open() {
    std::array<char, 256> ignored;
    for (;;) {
        const ssize_t n = recv(fd_, ignored.data(), ignored.size(), MSG_DONTWAIT);
        if (n > 0 || (n < 0 && errno == EINTR)) continue;
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
        throw ViewerLost(n == 0 ? "the viewer closed the connection" : errno_text(errno));
    }
}

std::size_t ViewerSocket::send_some(std::string_view bytes, std::chrono::milliseconds time) {
    for (bool waited = false;; waited = true) {
        const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n >= 0) return static_cast<std::size_t>(n);
        if (errno == EINTR) continue;
        if (errno != EAGAIN && errno != EWOULDBLOCK) throw ViewerLost(errno_text(errno));
        if (waited) return 0;
        if (waker_.wait(fd_, POLLOUT | POLLIN, time) & POLLIN) check_open();
    }
}

void ViewerSocket::wait(std::chrono::milliseconds time) {
    if (waker_.wait(fd_, POLLIN, time) != 0) check_open();
}

}  // namespace tessera
