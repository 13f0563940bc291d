#include "renderer/cli/tev_display.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <new>
#include <system_error>
#include <utility>

#include "renderer/cli/tev_packets.h"
#include "renderer/image/live_picture.h"

namespace tessera {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr std::chrono::milliseconds kFirstPause = 250ms, kLongestPause = 4s;
constexpr std::chrono::milliseconds kSteady = 5s;  // a connection that lived so long was a good one
constexpr std::chrono::milliseconds kStall = 3s;
constexpr std::chrono::milliseconds kLastStall = 1s, kLastTime = 10s, kStopTime = 200ms;

// Pixels may lie outside the frame; the viewer knows only pictures that begin at 0,0.
PixelWindow canvas_of(const TevPicture& p) {
    return {std::min(0, p.window.x0), std::min(0, p.window.y0), std::max(p.width, p.window.x1),
            std::max(p.height, p.window.y1)};
}

}  // namespace

struct TevDisplay::Sender {
    Sender(const ViewerAddress& to, const TevPicture& what,
           std::function<void(const std::string&)> how_to_warn)
        : address(to),
          name(what.name),
          canvas(canvas_of(what)),
          picture(what.window),
          warn(std::move(how_to_warn)) {}

    void run();
    void feed();
    void send(ViewerSocket& socket, std::string_view bytes);
    void pause(std::chrono::milliseconds time);
    void warn_once(const std::string& what);

    const ViewerAddress address;
    const std::string name;
    const PixelWindow canvas;
    LivePicture picture;
    Waker waker;
    std::atomic<bool> finishing{false};  // no more pixels come
    std::atomic<std::uint64_t> sent{0};  // bytes
    std::mutex mutex;                    // for what follows
    std::condition_variable done_changed;
    bool done = false;
    std::function<void(const std::string&)> warn;  // empty after the one call
};

void TevDisplay::Sender::warn_once(const std::string& what) {
    const std::lock_guard lock(mutex);
    if (const auto say = std::exchange(warn, nullptr))
        say("display " + address.host + ", port " + address.port + ": " + what);
}

void TevDisplay::Sender::send(ViewerSocket& socket, std::string_view bytes) {
    auto moved = Clock::now();
    while (!bytes.empty()) {
        if (waker.stopped()) throw ViewerLost("stopped");
        const std::size_t n = socket.send_some(bytes, 1s);
        bytes.remove_prefix(n);
        sent += n;
        if (n > 0) moved = Clock::now();
        if (Clock::now() - moved > kStall)
            warn_once("the viewer takes no more data; the render goes on without it");
    }
}

// Returns when the viewer has everything and no more will come.
void TevDisplay::Sender::feed() {
    ViewerSocket socket(address, waker);
    bool created = false;
    LivePicture::Piece piece;
    while (!waker.stopped()) {
        const bool last =
            finishing.load();  // before take(): what came earlier is then in the queue
        if (!created && picture.ready()) {
            send(socket, tev_create(name, canvas.width(), canvas.height(), picture.channels()));
            picture.take_all_again();
            created = true;
        }
        if (created && picture.take(piece)) {
            PixelWindow& w = piece.window;
            w = {w.x0 - canvas.x0, w.y0 - canvas.y0, w.x1 - canvas.x0, w.y1 - canvas.y0};
            send(socket, tev_update(name, picture.channels(), piece));
        } else if (last) {
            return;
        } else {
            socket.wait(kLastTime);
        }
    }
}

void TevDisplay::Sender::pause(std::chrono::milliseconds time) {
    const auto end = Clock::now() + time;
    for (auto now = Clock::now(); now < end && !waker.stopped() && !finishing; now = Clock::now())
        waker.wait(-1, 0, std::chrono::ceil<std::chrono::milliseconds>(end - now));
}

void TevDisplay::Sender::run() {
    std::chrono::milliseconds rest = kFirstPause;
    while (!waker.stopped()) {
        const bool last_try = finishing.load();
        const auto start = Clock::now();
        try {
            feed();
            break;
        } catch (const ViewerLost& lost) {
            if (waker.stopped()) break;
            warn_once(std::string(lost.what()) + "; the render goes on, and so do attempts");
        } catch (const std::bad_alloc&) {
            warn_once("out of memory; there is no preview");
            break;
        }
        if (last_try) break;
        if (Clock::now() - start > kSteady) rest = kFirstPause;
        pause(rest);
        rest = std::min(2 * rest, kLongestPause);
    }
    const std::lock_guard lock(mutex);
    done = true;
    done_changed.notify_all();
}

TevDisplay::TevDisplay(const ViewerAddress& address, const TevPicture& picture,
                       std::function<void(const std::string&)> warn)
    : sender_(std::make_shared<Sender>(address, picture, std::move(warn))) {
    try {
        thread_ = std::thread([sender = sender_] { sender->run(); });
    } catch (const std::system_error& error) {
        sender_->warn_once(std::string("there is no preview: ") + error.what());
    }
}

TevDisplay::~TevDisplay() { stop(); }

void TevDisplay::show(const PixelWindow& part, const std::vector<Layer>& layers) noexcept {
    if (!thread_.joinable()) return;
    try {
        if (sender_->picture.update(part, layers)) sender_->waker.wake();
    } catch (const std::bad_alloc&) {
        sender_->waker.stop();
    }
}

void TevDisplay::close() {
    if (!thread_.joinable()) return;
    sender_->finishing = true;
    sender_->waker.wake();
    bool late = false;
    {
        std::unique_lock lock(sender_->mutex);
        const auto end = Clock::now() + kLastTime;
        for (std::uint64_t before = sender_->sent; !late; before = sender_->sent) {
            const auto done = [&] { return sender_->done; };
            if (sender_->done_changed.wait_for(lock, kLastStall, done)) break;
            late = sender_->sent == before || Clock::now() > end;
        }
    }
    if (late) sender_->warn_once("the viewer did not take the last of the picture");
    stop();
}

void TevDisplay::stop() {
    if (!thread_.joinable()) return;
    sender_->waker.stop();
    std::unique_lock lock(sender_->mutex);
    const bool done =
        sender_->done_changed.wait_for(lock, kStopTime, [&] { return sender_->done; });
    sender_->warn = nullptr;
    lock.unlock();
    if (done)
        thread_.join();
    else
        thread_.detach();  // the look-up of a name cannot be interrupted
}

}  // namespace tessera
