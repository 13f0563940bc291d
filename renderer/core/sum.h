#pragma once
// Sums in twice the precision of double, so that neither the number of terms nor their grouping
// shows in the result: sample ranges that were rendered apart add up to the bits of the whole.
// Knuth, "The Art of Computer Programming" 2, 4.2.2, theorem B; Neumaier, "Rundungsfehleranalyse
// einiger Verfahren zur Summation endlicher Summen", ZAMM 54, 1974.

namespace tessera {

struct Sum {
    double high = 0, low = 0;

    void add(double v) noexcept {
        const double s = high + v, b = s - high;
        low += (high - (s - b)) + (v - b);
        high = s;
    }
    void add(const Sum& o) noexcept {
        add(o.high);
        low += o.low;
    }
    double value() const noexcept { return high + low; }
};

}  // namespace tessera
