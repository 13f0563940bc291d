#pragma once
// A picture that changes while somebody looks at it: threads put parts in, one reader takes out
// what changed. What changes again before it was taken is taken once, in its newest state, so
// nothing grows while the reader sleeps: memory is that of one picture in float.

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "renderer/api/image.h"

namespace tessera {

class LivePicture {
public:
    /// Part of the picture, planar: every pixel of the first channel, then of the second ...
    struct Piece {
        PixelWindow window;
        std::vector<float> pixels;
    };

    explicit LivePicture(const PixelWindow& window);
    ~LivePicture();

    /// The pixels of `part`, which lies in the window, as they are now. Every call names the
    /// channels of the first; layers after those, as mattes that come with the last one, are left
    /// out. Any thread; waits for copies of single cells only. True if a pixel changed its bits.
    bool update(const PixelWindow& part, const std::vector<Layer>& layers);

    /// False before the first update: there are no names yet.
    bool ready() const noexcept { return ready_.load(std::memory_order_acquire); }
    /// "R", "albedo.R" ... in the order of the layers. Once ready.
    const std::vector<std::string>& channels() const noexcept { return channels_; }
    /// What has waited longest; false if nothing waits. One thread.
    bool take(Piece& piece);
    /// Whatever was not zero at any time waits again. One thread.
    void take_all_again();

private:
    struct Cell;
    void start(const std::vector<Layer>& layers);
    bool put(const PixelWindow& area, const PixelWindow& part, const std::vector<Layer>& layers);
    PixelWindow cell_window(int column, int row) const;
    void enqueue(Cell& cell);

    PixelWindow window_;
    int columns_, rows_;
    std::unique_ptr<Cell[]> cells_;
    std::once_flag started_;
    std::atomic<bool> ready_{false};
    std::vector<std::string> channels_;
    std::vector<float> pixels_;  // planar, over the window
    std::mutex queue_mutex_;
    std::deque<Cell*> queue_;
};

}  // namespace tessera
