#pragma once
// A logarithmic axis: what it spans, where its ticks stand, what they say.

#include <string>
#include <vector>

namespace tessera {

struct Tick {
    double value = 0;
    std::string text;  // "": a small one
};

class LogAxis {
public:
    /// From `first` to `last`, in pixels, over all values that have a logarithm, with some room
    /// beside them; a decade about a single value, 0.1 to 10 about none.
    LogAxis(const std::vector<double>& values, double first, double last);

    double low() const noexcept { return low_; }
    double high() const noexcept { return high_; }
    /// Pixels; a value that has no logarithm, or is beyond an end, lies at that end.
    double at(double value) const noexcept;
    /// Labels at every decade, or at some of many; at 2 and 5 too, or at more, where decades are
    /// few.
    std::vector<Tick> ticks() const;

private:
    double low_ = 0.1, high_ = 10, first_, last_;
};

/// "0.01", "50", "10⁻⁵"
std::string tick_text(double value);

}  // namespace tessera
