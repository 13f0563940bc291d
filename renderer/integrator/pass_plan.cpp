#include "renderer/integrator/pass_plan.h"

#include <algorithm>

#include "renderer/error/replicates.h"

namespace tessera {
namespace {

constexpr double kShare = 0.5;     // of the time left, for one pass
constexpr double kSlower = 1.25;   // than those before a sample may be
constexpr double kEnough = 0.005;  // so little of the time may be left over
constexpr double kMemory = 0.25;   // weight of a pass against the next one
constexpr int kGrowth = 4, kCloseGrowth = 2;
constexpr int kCareful = 16;  // a pass takes this part of what is there at least

}  // namespace

int PassPlan::next(int done, double elapsed_s, int wanted) const {
    const int rest = spp_ - done;
    if (rest <= 0) return 0;
    const bool close = close_ || wanted > 0;
    int end = 1;
    while (end <= done) end *= close ? kCloseGrowth : kGrowth;
    int count = end - done;
    if (wanted > 0)
        count = std::min(
            count, std::max(wanted - done, kReplicates * (done / kCareful / kReplicates + 1)));
    if (time_s_ > 0) count = std::min(whole(done, affordable(elapsed_s)), close ? count : rest);
    return std::min(count, rest);
}

// So that the runs of points that grow are equally long.
int PassPlan::whole(int done, int count) {
    const int over = (done + count) % kReplicates;
    return count > over ? count - over : count;
}

int PassPlan::affordable(double elapsed_s) const {
    if (taken_ == 0) return 1;
    const double left = time_s_ - elapsed_s, each = std::max(seconds_ / samples_, 1e-12);
    if (left < kEnough * time_s_) return 0;
    const double count = std::min(kShare * left / each, static_cast<double>(kGrowth) * taken_);
    if (count >= 1) return static_cast<int>(std::min(count, 1e9));
    return kSlower * each <= left + kLate * time_s_ ? 1 : 0;
}

void PassPlan::took(int samples, double seconds) {
    taken_ += samples;
    samples_ = kMemory * samples_ + samples;
    seconds_ = kMemory * seconds_ + seconds;
}

}  // namespace tessera
