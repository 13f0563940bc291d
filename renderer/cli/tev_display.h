#pragma once
// Live preview in the tev viewer. A thread of its own talks to the viewer; the render only copies
// pixels into memory, so a viewer that hangs, leaves or never came costs it nothing more.

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/cli/viewer_socket.h"

namespace tessera {

/// What the viewer shows: a picture of this name, as large as frame and window together.
struct TevPicture {
    std::string name;
    int width = 0, height = 0;  // of the frame
    PixelWindow window;         // the pixels that will come
};

class TevDisplay {
public:
    /// Starts to connect. warn is called once at most, from another thread, when something is wrong
    /// with the viewer; not after close().
    TevDisplay(const ViewerAddress& address, const TevPicture& picture,
               std::function<void(const std::string&)> warn);
    /// Stops at once.
    ~TevDisplay();
    TevDisplay(const TevDisplay&) = delete;
    TevDisplay& operator=(const TevDisplay&) = delete;

    /// These pixels are now so; from any thread.
    void show(const PixelWindow& part, const std::vector<Layer>& layers) noexcept;
    /// Lets the viewer have what it has not got yet. Gives up when it takes nothing for a second,
    /// after ten seconds at the latest.
    void close();

private:
    struct Sender;
    void stop();

    std::shared_ptr<Sender> sender_;  // outlives this while its thread looks up a name
    std::thread thread_;
};

}  // namespace tessera
