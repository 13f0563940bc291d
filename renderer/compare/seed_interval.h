#pragma once
// What several seeds tell of a number.

#include <span>

namespace tessera {

/// Mean, and where the expectation lies with 95 % confidence; low = high = mean for one value.
struct SeedInterval {
    double mean = 0, low = 0, high = 0;
    int count = 0;
};

/// Student's t-interval ("The Probable Error of a Mean", Biometrika 6, 1908). An infinite value
/// makes all infinite.
SeedInterval seed_interval(std::span<const double> values);

/// The t that a variable of n degrees of freedom exceeds with probability 2.5 %, n >= 1.
double student_t(int n) noexcept;

/// Which of two errors is less, as far as that can be told: by several seeds each, whose intervals
/// do not overlap.
enum class Closer : unsigned char { unknown, a, b };
Closer closer(const SeedInterval& a, const SeedInterval& b, bool less_is_closer) noexcept;

}  // namespace tessera
