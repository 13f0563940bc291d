#include "renderer/film/beauty.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tessera {

Beauty::Beauty(const PixelWindow& w, std::optional<std::uint64_t> probes_seed) : window_(w) {
    if (probes_seed) probes_.emplace(w, *probes_seed);
    const std::size_t n =
        static_cast<std::size_t>(w.width()) * static_cast<std::size_t>(w.height());
    sums_.resize(first(n, 0));
    counts_.resize(n);
}

void Beauty::add(std::size_t i, std::uint32_t sample, const PathSample& s) noexcept {
    const std::uint32_t point = point_of_sample(sample), log_run = run_of(point);
    PixelCounts& n = counts_[i];
    if (log_run > n.log_run) lengthen_runs(i, log_run);
    const std::uint32_t replicate = point >> n.log_run;
    Sum* const sums = at(i, replicate);
    sums[0].add(static_cast<double>(s.radiance.x));
    sums[1].add(static_cast<double>(s.radiance.y));
    sums[2].add(static_cast<double>(s.radiance.z));
    n.hits += s.alpha > 0.0f;
    ++n.samples[replicate];
}

// Neighbouring runs become one.
void Beauty::lengthen_runs(std::size_t i, std::uint32_t log_run) noexcept {
    PixelCounts& n = counts_[i];
    const std::uint32_t by = log_run - n.log_run;
    n.log_run = log_run;
    for (std::uint32_t r = 1; r < kReplicates; ++r) {
        const std::uint32_t to = r >> by;
        if (n.samples[r] == 0) continue;
        n.samples[to] += std::exchange(n.samples[r], 0);
        if (!probes_) continue;
        for (std::size_t c = 0; c < 3; ++c) at(i, to)[c].add(std::exchange(at(i, r)[c], {}));
    }
}

void Beauty::merge(std::size_t to, const Beauty& other, std::size_t from) noexcept {
    const PixelCounts& more = other.counts_[from];
    PixelCounts& n = counts_[to];
    if (more.log_run > n.log_run) lengthen_runs(to, more.log_run);
    n.hits += more.hits;
    for (std::uint32_t r = 0; r < kReplicates; ++r) {
        const std::uint32_t as = r >> (n.log_run - more.log_run);
        n.samples[as] += more.samples[r];
        if (!probes_ && r > 0) continue;
        for (std::size_t c = 0; c < 3; ++c)
            at(to, as)[c].add(other.sums_[other.first(from, r) + c]);
    }
}

void Beauty::merge_probes(const Beauty& other) {
    if (probes_) probes_->merge(*other.probes_, other.window_);
}

Sum Beauty::sum(std::size_t i, std::size_t channel) const noexcept {
    Sum sum;
    for (std::size_t k = first(i, 0); k < first(i + 1, 0); k += 3) sum.add(sums_[k + channel]);
    return sum;
}

ReplicateView Beauty::replicates() const noexcept {
    if (!probes_) return {};
    return {window_, sums_, counts_, {probes_->grid(), probes_->sums(), probes_->counts()}};
}

void Beauty::standard_error(std::size_t i, double calibration, float* rgb) const noexcept {
    const PixelCounts& n = counts_[i];
    const double total = n.total();
    std::fill_n(rgb, 3, 0.0f);
    if (!probes_ || !n.has_all()) return;
    for (std::size_t c = 0; c < 3; ++c) {
        const double mean = sum(i, c).value() / total;
        double sum = 0;
        for (std::size_t r = 0; r < kReplicates; ++r) {
            const double off = sums_[first(i, r) + c].value() / n.samples[r] - mean;
            sum += n.samples[r] / total * off * off;
        }
        rgb[c] = static_cast<float>(std::sqrt(calibration * sum / (kReplicates - 1)));
    }
}

bool Beauty::counts_make_sense() const noexcept {
    return std::none_of(counts_.begin(), counts_.end(),
                        [](const PixelCounts& n) { return n.log_run > run_of(~0u); });
}

std::size_t Beauty::bytes() const noexcept {
    const std::size_t own =
        sums_.capacity() * sizeof(Sum) + counts_.capacity() * sizeof(PixelCounts);
    return own + (probes_ ? probes_->bytes() : 0);
}

}  // namespace tessera
