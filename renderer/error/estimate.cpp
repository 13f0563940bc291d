#include "renderer/error/estimate.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/parallel.h"
#include "renderer/error/calibration.h"
#include "renderer/error/interval.h"
#include "renderer/error/tile_error.h"

namespace tessera {
namespace {

constexpr int kTile = 32;

struct Tile {
    PixelWindow window;
    double sum = 0;
    TileError error;
};

std::vector<Tile> tiles_of(const PixelWindow& w) {
    std::vector<Tile> out;
    const auto start = [](int v) { return v - ((v % kTile) + kTile) % kTile; };
    for (int y = start(w.y0); y < w.y1; y += kTile) {
        for (int x = start(w.x0); x < w.x1; x += kTile) {
            Tile t;
            t.window = {std::max(x, w.x0), std::max(y, w.y0), std::min(x + kTile, w.x1),
                        std::min(y + kTile, w.y1)};
            out.push_back(t);
        }
    }
    return out;
}

double pixels_of(const PixelWindow& w) { return static_cast<double>(w.width()) * w.height(); }

// Of the tile where the error is largest, which may be another than it seems.
void find_worst(const std::vector<Tile>& tiles, ErrorEstimate& out) {
    const double quantile = joint_quantile(tiles.size());
    bool any = false;
    for (const Tile& t : tiles) {
        const Interval i = root(mean_interval(t.error.absolute, pixels_of(t.window), quantile));
        if (!any || i.value > out.worst_tile.value) {
            out.worst_tile.value = i.value;
            out.tile = t.window;
            any = true;
        }
        out.worst_tile.low = std::max(out.worst_tile.low, i.low);
        out.worst_tile.high = std::max(out.worst_tile.high, i.high);
    }
}

}  // namespace

ErrorEstimate estimate_error(const ReplicateView& picture, Workers& workers) {
    const PixelWindow& window = picture.window;
    std::vector<Tile> tiles = tiles_of(window);
    const int count = static_cast<int>(tiles.size());
    workers.for_each(count, [&](int t) { tiles[t].sum = tile_sum(picture, tiles[t].window); });
    double sum = 0;
    for (const Tile& t : tiles) sum += t.sum;
    const double mean = sum / std::max(pixels_of(window), 1.0);
    ErrorEstimate out;
    out.asked = true;
    out.epsilon = 0.01 * mean * mean;
    const double epsilon = std::max(out.epsilon, 1e-30);  // of a black picture
    workers.for_each(
        count, [&](int t) { tiles[t].error = tile_error(picture, tiles[t].window, epsilon); });
    TileError all;
    for (const Tile& t : tiles) {
        all.absolute.add(t.error.absolute);
        all.low.add(t.error.low);
        all.high.add(t.error.high);
        all.absolute_halves.add(t.error.absolute_halves);
        all.relative_halves.add(t.error.relative_halves);
        all.known &= t.error.known;
    }
    out.known = all.known && count > 0;
    if (!out.known) return out;
    const Calibration calibration = calibrate(picture, all, epsilon);
    out.calibration = calibration.squared.value;
    for (Tile& t : tiles)
        t.error.absolute.scale(calibration.squared.value, calibration.squared.spread);
    all.absolute.scale(calibration.squared.value, calibration.squared.spread);
    all.low.scale(calibration.relative.value, calibration.relative.spread);
    all.high.scale(calibration.relative.value, calibration.relative.spread);
    out.rmse = root(mean_interval(all.absolute, pixels_of(window), kQuantile));
    out.relmse = mean_interval(relative_error(all), pixels_of(window), kQuantile);
    find_worst(tiles, out);
    if (all.absolute.error > 0) out.largest_share = all.absolute.largest / all.absolute.error;
    judge(all, out);
    return out;
}

}  // namespace tessera
