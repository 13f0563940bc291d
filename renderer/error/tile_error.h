#pragma once
// What the replicates of a tile's pixels say of their means' errors.

#include "renderer/api/scene_desc.h"
#include "renderer/error/replicates.h"

namespace tessera {

/// Sums over pixels of an error (the mean of three channels) and of how far it may be off.
struct ErrorSums {
    double error = 0;    // squared
    double spread = 0;   // variance of the error as it turned out in this picture, about `error`
    double spread2 = 0;  // sum of squares of the pixels' spreads
    double largest = 0;  // of a pixel's errors

    void add(const ErrorSums& o) noexcept;
    /// By a factor, whose logarithm has a variance.
    void scale(double factor, double variance) noexcept;
    /// On how many pixels the spread stands.
    double pixels_behind() const noexcept;
};

/// With replicates x_r of equal size about the truth t, their mean m and v = s^2/K, (m - t)^2 - v
/// is the sum of (x_i - t)(x_j - t) over i != j divided by K(K-1): no kurtosis enters. Its variance
/// is 2 sigma^4 / (K(K-1)), and sigma^4 has an unbiased estimate, whatever the distribution, in
/// products of differences within two disjoint pairs.
///
/// Relative errors want 1/(t^2 + epsilon). With m for t they come out too low, because a pixel that
/// is too bright by chance seems to bear more error. With the error of two replicates and t from
/// the other two, y and z, that is cured; then 1/x^2 is convex, which 3/4 (y - z)^2 in the
/// denominator makes good to first order, and what is rarer than the replicates are many leaves
/// them too high. Both are summed up; the truth lies between (relative_error()).
struct TileError {
    // Squared errors as both halves of the samples tell them, two runs each.
    struct Halves {
        double error = 0, squares = 0;  // sums over pixels

        void add(const Halves& o) noexcept { error += o.error, squares += o.squares; }
    };
    Halves absolute_halves, relative_halves;
    ErrorSums absolute;
    ErrorSums low, high;  // relative: of both the same spread, with half their difference for what
                          // that leaves open
    bool known = true;    // every pixel has all replicates
};

/// part: of the picture, in the frame.
TileError tile_error(const ReplicateView& picture, const PixelWindow& part,
                     double epsilon) noexcept;

/// Sum over the part's pixels of the mean of their channels.
double tile_sum(const ReplicateView& picture, const PixelWindow& part) noexcept;

}  // namespace tessera
