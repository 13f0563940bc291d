#pragma once
// How many samples each pass over the picture takes. No pixel's bits depend on it.

namespace tessera {

/// Without a time passes end at powers of four, where the sequences of all replicates are whole: an
/// early stop leaves an even picture, and the estimate of the end is soon good. With a time none is
/// planned to take more than half of what is left, so that not even a machine that gets twice as
/// slow is late; at the end single samples are, by at most kLate of the time if a sample takes up
/// to a quarter more than its predecessors.
class PassPlan {
public:
    static constexpr double kLate = 0.03;

    /// time_s <= 0: spp alone decides. Close: passes end at powers of two at least.
    PassPlan(int spp, double time_s, bool close = false)
        : spp_(spp), time_s_(time_s), close_(close) {}

    /// Samples of the next pass when `done` are there after so many seconds; 0: that is all.
    /// wanted: where the error is thought to be small enough (0: that is no matter); looked at more
    /// often then.
    int next(int done, double elapsed_s, int wanted = 0) const;
    /// A pass is through.
    void took(int samples, double seconds);

private:
    int affordable(double elapsed_s) const;
    static int whole(int done, int count);

    int spp_;
    double time_s_;
    bool close_;
    int taken_ = 0;
    double samples_ = 0, seconds_ = 0;  // of the latest passes
};

}  // namespace tessera
