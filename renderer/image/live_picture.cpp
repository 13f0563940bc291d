#include "renderer/image/live_picture.h"

#include <algorithm>
#include <bit>

namespace tessera {
namespace {

constexpr int kCell = 64;  // pixels; two tiles of the usual size

bool is_empty(const PixelWindow& w) { return w.x0 >= w.x1 || w.y0 >= w.y1; }

PixelWindow overlap(const PixelWindow& a, const PixelWindow& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

PixelWindow around(const PixelWindow& a, const PixelWindow& b) {
    if (is_empty(a)) return b;
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

std::size_t index_in(const PixelWindow& w, int x, int y) {
    return static_cast<std::size_t>(y - w.y0) * static_cast<std::size_t>(w.width()) +
           static_cast<std::size_t>(x - w.x0);
}

std::size_t area_of(const PixelWindow& w) {
    return static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height());
}

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace

struct LivePicture::Cell {
    std::mutex mutex;  // for what follows and the cell's pixels
    PixelWindow waiting, ever;
    bool queued = false;
};

LivePicture::LivePicture(const PixelWindow& window)
    : window_(window),
      columns_((window.width() + kCell - 1) / kCell),
      rows_((window.height() + kCell - 1) / kCell),
      cells_(std::make_unique<Cell[]>(static_cast<std::size_t>(columns_) *
                                      static_cast<std::size_t>(rows_))) {}

LivePicture::~LivePicture() = default;

void LivePicture::start(const std::vector<Layer>& layers) {
    std::vector<std::string> names;
    for (const Layer& layer : layers) {
        for (const std::string& c : layer.channels)
            names.push_back(layer.name.empty() ? c : layer.name + "." + c);
    }
    pixels_.resize(area_of(window_) * names.size());
    channels_ = std::move(names);
    ready_.store(true, std::memory_order_release);
}

PixelWindow LivePicture::cell_window(int column, int row) const {
    const int x = window_.x0 + column * kCell, y = window_.y0 + row * kCell;
    return overlap(window_, {x, y, x + kCell, y + kCell});
}

bool LivePicture::update(const PixelWindow& part, const std::vector<Layer>& layers) {
    std::call_once(started_, [&] { start(layers); });
    const PixelWindow inside = overlap(part, window_);
    if (is_empty(inside)) return false;
    bool changed = false;
    for (int row = (inside.y0 - window_.y0) / kCell; row <= (inside.y1 - 1 - window_.y0) / kCell;
         ++row) {
        for (int column = (inside.x0 - window_.x0) / kCell;
             column <= (inside.x1 - 1 - window_.x0) / kCell; ++column) {
            const PixelWindow area = overlap(inside, cell_window(column, row));
            Cell& cell = cells_[static_cast<std::size_t>(row) * columns_ + column];
            const std::lock_guard lock(cell.mutex);
            if (!put(area, part, layers)) continue;
            changed = true;
            cell.waiting = around(cell.waiting, area);
            cell.ever = around(cell.ever, area);
            enqueue(cell);
        }
    }
    return changed;
}

bool LivePicture::put(const PixelWindow& area, const PixelWindow& part,
                      const std::vector<Layer>& layers) {
    const std::size_t plane = area_of(window_);
    std::size_t first = 0;
    bool changed = false;
    for (const Layer& layer : layers) {
        const std::size_t count = layer.channels.size();
        if (first + count > channels_.size()) break;
        for (int y = area.y0; y < area.y1; ++y) {
            const float* from = layer.pixels.data() + index_in(part, area.x0, y) * count;
            for (int x = area.x0; x < area.x1; ++x, from += count) {
                float* to = pixels_.data() + first * plane + index_in(window_, x, y);
                for (std::size_t c = 0; c < count; ++c, to += plane) {
                    changed |= !same_bits(*to, from[c]);
                    *to = from[c];
                }
            }
        }
        first += count;
    }
    return changed;
}

void LivePicture::enqueue(Cell& cell) {
    if (cell.queued) return;
    cell.queued = true;
    const std::lock_guard lock(queue_mutex_);
    queue_.push_back(&cell);
}

bool LivePicture::take(Piece& piece) {
    Cell* cell = nullptr;
    {
        const std::lock_guard lock(queue_mutex_);
        if (queue_.empty()) return false;
        cell = queue_.front();
        queue_.pop_front();
    }
    const std::lock_guard lock(cell->mutex);
    piece.window = cell->waiting;
    piece.pixels.clear();
    const auto width = static_cast<std::ptrdiff_t>(piece.window.width());
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        for (int y = piece.window.y0; y < piece.window.y1; ++y) {
            const float* row =
                pixels_.data() + c * area_of(window_) + index_in(window_, piece.window.x0, y);
            piece.pixels.insert(piece.pixels.end(), row, row + width);
        }
    }
    cell->waiting = {};
    cell->queued = false;
    return true;
}

void LivePicture::take_all_again() {
    const std::size_t cells = static_cast<std::size_t>(columns_) * rows_;
    for (std::size_t i = 0; i < cells; ++i) {
        Cell& cell = cells_[i];
        const std::lock_guard lock(cell.mutex);
        if (is_empty(cell.ever)) continue;
        cell.waiting = cell.ever;
        enqueue(cell);
    }
}

}  // namespace tessera
