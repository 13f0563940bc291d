#pragma once
// Sums of errors to numbers between which they lie, and whether that can be relied on.

#include "renderer/api/picture_error.h"
#include "renderer/error/tile_error.h"

namespace tessera {

inline constexpr double kQuantile = 1.959963984540054;  // of the normal distribution, 97.5 %

/// Of the mean over pixels. Relative, so that it does not reach below zero; not yet reliable.
Interval mean_interval(const ErrorSums& sums, double pixels, double quantile) noexcept;

/// A normal quantile for so many degrees of freedom (Cornish and Fisher, "Moments and Cumulants in
/// the Specification of Distributions", Revue de l'Institut International de Statistique 5, 1938).
double student(double quantile, double degrees) noexcept;

Interval root(const Interval& i) noexcept;

/// The quantile that n independent intervals all hold with in 95 of 100 cases (Sidak, "Rectangular
/// Confidence Regions", JASA 62, 1967).
double joint_quantile(std::size_t n) noexcept;

/// Between the two estimates, nearer to the higher one, whose fault falls faster with the samples.
/// How near is measured, not derived (docs/error.md).
ErrorSums relative_error(const TileError& error) noexcept;

/// Says what of the estimate is reliable, and why not; widens what is known less well than its
/// spread says.
void judge(const TileError& all, ErrorEstimate& estimate);

}  // namespace tessera
