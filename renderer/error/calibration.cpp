#include "renderer/error/calibration.h"

#include <algorithm>
#include <cmath>

#include "renderer/error/interval.h"

namespace tessera {
namespace {

// What is known before any probe is asked. If the error falls from quarters to halves as it does
// from halves to the whole, the factor is the square of the one between the first two. How far that
// is off, as a standard deviation of logarithms between scenes, and its limits (docs/error.md).
constexpr double kDoubt = 0.4, kLeast = 0.2, kMost = 1.1;

Calibration::Factor expected(const TileError::Halves& halves, double quarters) {
    const double doubt = kDoubt * kDoubt;
    if (!(halves.error > 0) || !(quarters > 0)) return {1, doubt};
    const double ratio = halves.error / quarters;
    // A half's error has one degree of freedom: its variance is two thirds of its mean square.
    const double spread = 2.0 / 3.0 * halves.squares / (halves.error * halves.error);
    return {std::clamp(ratio * ratio, kLeast, kMost), doubt + 4 * spread};
}

// What a probe has of a channel.
struct Seen {
    double mean = 0;      // of both renderings
    double expected = 0;  // the squared error that the replicates tell
    double found = 0;     // half the squared difference of the renderings

    Seen(const ReplicateView& v, std::size_t pixel, std::size_t cell, std::size_t channel) {
        const PixelCounts& n = v.counts[pixel];
        const Sum* const sums = &v.sums[pixel * kReplicates * 3 + channel];
        const double each = 1.0 / n.total();
        double first = 0;
        for (std::size_t r = 0; r < kReplicates; ++r) first += sums[3 * r].value() * each;
        for (std::size_t r = 0; r < kReplicates; ++r) {
            const double off = sums[3 * r].value() / n.samples[r] - first;
            expected += n.samples[r] * each * off * off / (kReplicates - 1);
        }
        const double second = v.probes.sums[3 * cell + channel].value() * each;
        found = 0.5 * (first - second) * (first - second);
        mean = 0.5 * (first + second);
    }
};

// Of all probes; a ratio of sums.
class Ratio {
public:
    void add(double expected, double found) {
        e_ += expected, f_ += found;
        ee_ += expected * expected, ff_ += found * found, ef_ += expected * found;
    }
    Calibration::Factor factor(const Calibration::Factor& before) const {
        if (!(e_ > 0) || !(f_ > 0)) return before;
        const double ratio = f_ / e_;
        // Of the sum of found - ratio * expected.
        const double off = std::max(ff_ - 2 * ratio * ef_ + ratio * ratio * ee_, 0.0);
        const double probes = f_ * f_ / ff_;  // that make the sum
        if (!(probes > 1.5)) return before;
        const double few = student(kQuantile, probes - 1) / kQuantile;
        const double spread = few * few * off / (f_ * f_) * probes / (probes - 1);
        const double share = before.spread / (before.spread + spread);
        return {std::exp(share * std::log(ratio) + (1 - share) * std::log(before.value)),
                spread * share};
    }

private:
    double e_ = 0, f_ = 0, ee_ = 0, ff_ = 0, ef_ = 0;
};

}  // namespace

Calibration calibrate(const ReplicateView& v, const TileError& all, double epsilon) {
    Calibration out;
    Ratio squared, relative;
    v.probes.grid.each_inside(v.window, [&](std::size_t cell, ProbeGrid::Pixel p) {
        const std::size_t pixel = v.pixel(p.x, p.y);
        const PixelCounts& n = v.counts[pixel];
        if (!n.has_all() || v.probes.counts[cell] != n.total()) return;
        ++out.probes;
        double expected = 0, found = 0, expected_relative = 0, found_relative = 0;
        for (std::size_t c = 0; c < ReplicateView::kChannels; ++c) {
            const Seen s(v, pixel, cell, c);
            const double weight =
                s.mean * s.mean + epsilon > 0 ? 1 / (s.mean * s.mean + epsilon) : 0;
            expected += s.expected, found += s.found;
            expected_relative += weight * s.expected, found_relative += weight * s.found;
        }
        squared.add(expected, found);
        relative.add(expected_relative, found_relative);
    });
    out.squared = squared.factor(expected(all.absolute_halves, all.absolute.error));
    out.relative = relative.factor(expected(all.relative_halves, all.low.error));
    return out;
}

}  // namespace tessera
