#include "renderer/error/tile_error.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/ray.h"

namespace tessera {
namespace {

constexpr int kChannels = ReplicateView::kChannels;

// The three ways to make two pairs of four replicates, and thereby the six to have two apart.
constexpr int kMatches[3][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}};

// Sixteen pixels by components, for the compiler to vectorise. Lanes without a pixel have no error.
struct alignas(64) Pixels {
    float x[kChannels][kReplicates][kLanes];  // means of replicates
    float w[kReplicates][kLanes];             // their shares of the samples

    Pixels(const ReplicateView& v, std::size_t first, int count, bool& known) {
        for (int lane = 0; lane < kLanes; ++lane) {
            if (lane >= count) {
                clear(lane);
                continue;
            }
            const std::size_t p = first + static_cast<std::size_t>(lane);
            const PixelCounts& n = v.counts[p];
            const Sum* const sums = &v.sums[p * kReplicates * kChannels];
            const float each = 1.0f / static_cast<float>(std::max(n.total(), 1u));
            for (int r = 0; r < kReplicates; ++r) {
                if (n.samples[r] == 0) known = false;
                const double inverse = 1.0 / std::max(n.samples[r], 1u);
                w[r][lane] = static_cast<float>(n.samples[r]) * each;
                for (int c = 0; c < kChannels; ++c)
                    x[c][r][lane] = static_cast<float>(sums[r * kChannels + c].value() * inverse);
            }
        }
    }
    void clear(int lane) {
        for (int r = 0; r < kReplicates; ++r) {
            w[r][lane] = 1.0f / kReplicates;
            for (auto& channel : x) channel[r][lane] = 0.0f;
        }
    }
};

struct alignas(64) Lane {
    float of[kLanes]{};
};

// Two replicates.
struct Pair {
    float mean, gap2, error;  // error: squared, as a share of that of the mean of all

    Pair(float x0, float x1, float w0, float w1) {
        const float sum = w0 + w1, gap = x0 - x1;
        mean = (w0 * x0 + w1 * x1) / sum;
        gap2 = gap * gap;
        error = gap2 * (w0 * w1 / sum);
    }
    // What stands for the square of the truth.
    float square(float epsilon) const { return mean * mean + 0.75f * gap2 + epsilon; }
};

struct Sixteen {
    Lane absolute, low, high;  // errors
    Lane absolute_halves, relative_halves;
    // By match: sums over channels of products of differences.
    Lane absolute_off[3], relative_off[3];

    [[gnu::flatten]] void add_channel(const Pixels& p, int c, float epsilon) {
        for (int i = 0; i < kLanes; ++i) {
            const float x[4] = {p.x[c][0][i], p.x[c][1][i], p.x[c][2][i], p.x[c][3][i]};
            const float w[4] = {p.w[0][i], p.w[1][i], p.w[2][i], p.w[3][i]};
            float mean = 0.0f, variance = 0.0f, split = 0.0f;
            for (int r = 0; r < 4; ++r) mean += w[r] * x[r];
            for (int r = 0; r < 4; ++r) variance += w[r] * (x[r] - mean) * (x[r] - mean);
            variance *= 1.0f / (kReplicates - 1);
            for (const auto& m : kMatches) {
                const Pair a(x[m[0]], x[m[1]], w[m[0]], w[m[1]]);
                const Pair b(x[m[2]], x[m[3]], w[m[2]], w[m[3]]);
                split += a.error / b.square(epsilon) + b.error / a.square(epsilon);
            }
            const float first = w[0] + w[1], second = w[2] + w[3];
            const float gap =
                (w[0] * x[0] + w[1] * x[1]) * second - (w[2] * x[2] + w[3] * x[3]) * first;
            const float halves = gap * gap / (first * second);
            absolute_halves.of[i] += halves;
            relative_halves.of[i] += halves / (mean * mean + epsilon);
            const float least = variance / (mean * mean + epsilon), most = split * (1.0f / 6.0f);
            const float weight = variance > 0.0f ? 0.5f * (least + most) / variance : 0.0f;
            absolute.of[i] += variance, low.of[i] += least, high.of[i] += most;
            for (int k = 0; k < 3; ++k) {
                const auto& m = kMatches[k];
                const float product = (x[m[0]] - x[m[1]]) * (x[m[2]] - x[m[3]]);
                absolute_off[k].of[i] += product;
                relative_off[k].of[i] += weight * product;
            }
        }
    }
    // How far relative errors may be off for want of the truth.
    Lane half_bracket() const {
        Lane out;
        for (int i = 0; i < kLanes; ++i) out.of[i] = 0.5f * (high.of[i] - low.of[i]);
        return out;
    }
};

// A pixel's spread is 2/(K(K-1)) of sigma^4, which is a twelfth of the sum over matches; the error
// is a third of the channels' sum.
constexpr double kSpread = 2.0 / (kReplicates * (kReplicates - 1)) / 12.0 / (kChannels * kChannels);

// Where one replicate alone saw something rare the products vanish: at least so much of the squared
// error is added, of relative ones, whose weights are known less well, about what normal noise has
// (docs/error.md).
constexpr double kFloor = 0.005, kRelativeFloor = 0.25;

// more: sds of what else is unknown, which come on top.
void add(ErrorSums& sums, const Lane& error, const Lane (&off)[3], const Lane& more, double floor) {
    for (int i = 0; i < kLanes; ++i) {
        double spread = 0;
        for (const Lane& o : off)
            spread += static_cast<double>(o.of[i]) * static_cast<double>(o.of[i]);
        const double m = static_cast<double>(more.of[i]) / kChannels;
        const double e = static_cast<double>(error.of[i]) / kChannels;
        spread = spread * kSpread + m * m + floor * e * e;
        sums.error += e;
        sums.spread += spread;
        sums.spread2 += spread * spread;
        sums.largest = std::max(sums.largest, e);
    }
}

void add(TileError::Halves& sums, const Lane& error) {
    for (const float of : error.of) {
        const double e = static_cast<double>(of) / kChannels;
        sums.error += e;
        sums.squares += e * e;
    }
}

}  // namespace

void ErrorSums::scale(double factor, double variance) noexcept {
    error *= factor;
    spread = spread * factor * factor + variance * error * error;
    spread2 *= factor * factor * factor * factor;
    largest *= factor;
}

void ErrorSums::add(const ErrorSums& o) noexcept {
    error += o.error;
    spread += o.spread;
    spread2 += o.spread2;
    largest = std::max(largest, o.largest);
}

double ErrorSums::pixels_behind() const noexcept {
    return spread2 > 0 ? spread * spread / spread2 : 0;
}

TileError tile_error(const ReplicateView& v, const PixelWindow& part, double epsilon) noexcept {
    TileError out;
    for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; x += kLanes) {
            const std::size_t first = v.pixel(x, y);
            const Pixels pixels(v, first, std::min(kLanes, part.x1 - x), out.known);
            Sixteen s;
            for (int c = 0; c < kChannels; ++c)
                s.add_channel(pixels, c, static_cast<float>(epsilon));
            add(out.absolute, s.absolute, s.absolute_off, {}, kFloor);
            add(out.absolute_halves, s.absolute_halves);
            add(out.relative_halves, s.relative_halves);
            add(out.low, s.low, s.relative_off, s.half_bracket(), kRelativeFloor);
            add(out.high, s.high, s.relative_off, s.half_bracket(), kRelativeFloor);
        }
    }
    return out;
}

double tile_sum(const ReplicateView& v, const PixelWindow& part) noexcept {
    double sum = 0;
    for (int y = part.y0; y < part.y1; ++y) {
        for (int x = part.x0; x < part.x1; ++x) {
            const std::size_t p = v.pixel(x, y);
            double pixel = 0;
            for (int k = 0; k < kReplicates * kChannels; ++k)
                pixel += v.sums[p * kReplicates * kChannels + static_cast<std::size_t>(k)].value();
            sum += pixel / std::max(v.counts[p].total(), 1u);
        }
    }
    return sum / kChannels;
}

}  // namespace tessera
