#pragma once
// How fast an error falls: the slope of its logarithm against that of time or samples.

#include <span>

namespace tessera {

/// A number and, where it is known, its 95 % interval.
struct Ranged {
    double value = 0, low = 0, high = 0;
    bool known = false;    // the value is
    bool bounded = false;  // the interval is
};

/// Least squares of y = a + b x through ln x, ln y: b = Sxy / Sxx, with the standard error
/// sqrt(sum of squared residuals / (n - 2) / Sxx) and Student's t for n - 2 (Draper and Smith,
/// "Applied Regression Analysis", 1998, ch. 1). Pairs that have no logarithm are left out; two
/// different x give a value, three points an interval. Points of one render share their samples,
/// which the interval does not know: several seeds do.
Ranged fit_slope(std::span<const double> x, std::span<const double> y);

/// The mean of one number a seed, with Student's interval of several.
Ranged over_seeds(std::span<const double> values);

/// The same of slopes; a single one keeps its own interval.
Ranged over_seeds(std::span<const Ranged> slopes);

}  // namespace tessera
