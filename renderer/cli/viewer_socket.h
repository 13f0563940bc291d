#pragma once
// A one-way TCP connection to a viewer that may be slow, hung or gone. Nothing here waits longer
// than it is told to, and Waker::stop() ends every wait at once, except the look-up of a host's
// name.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

struct addrinfo;

namespace tessera {

struct ViewerAddress {
    std::string host, port;
};

/// "host", "host:port", "127.0.0.1:14158", "[::1]:14158", "::1"; without a port tev's own, 14158.
/// Throws Error(usage).
ViewerAddress parse_viewer_address(const std::string& text);

/// Ends waits of another thread.
class Waker {
public:
    Waker();
    ~Waker();
    Waker(const Waker&) = delete;
    Waker& operator=(const Waker&) = delete;

    /// Ends the wait under way or the next one.
    void wake() noexcept;
    /// Ends it for good: stopped() from now on.
    void stop() noexcept;
    bool stopped() const noexcept { return stopped_.load(); }
    /// Until the socket (-1: none) is ready for one of poll()'s events, wake() is called or the
    /// time has passed. Gives what the socket is ready for.
    short wait(int socket, short events, std::chrono::milliseconds time) noexcept;

private:
    std::atomic<bool> stopped_{false};
    int fd_;
};

/// The connection cannot be made or is lost; what() says why.
struct ViewerLost : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class ViewerSocket {
public:
    /// Tries every address of the host, 3 s each. Throws ViewerLost.
    ViewerSocket(const ViewerAddress& address, Waker& waker);
    ~ViewerSocket();
    ViewerSocket(const ViewerSocket&) = delete;
    ViewerSocket& operator=(const ViewerSocket&) = delete;

    /// Sends what the connection takes, waiting for it to take something; 0 if time passed or a
    /// wake() came before. Throws ViewerLost.
    std::size_t send_some(std::string_view bytes, std::chrono::milliseconds time);
    /// Waits for wake(). Throws ViewerLost when the viewer closes the connection.
    void wait(std::chrono::milliseconds time);

private:
    std::string connect_to(const addrinfo& address);
    void check_open();

    Waker& waker_;
    int fd_ = -1;
};

}  // namespace tessera
