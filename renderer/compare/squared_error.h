#pragma once
// Errors that are sums of squares.

#include <vector>

#include "renderer/compare/picture_view.h"

namespace tessera {

/// What the errors are relative to.
struct ReferenceScale {
    double epsilon = 0;  // of relMSE, in the square of the values
    double peak = 0;     // of PSNR: the largest value, 0 if none is positive
};

/// epsilon is kRelativeEpsilon times the square of the mean over all values, so that exposure does
/// not matter.
inline constexpr double kRelativeEpsilon = 0.01;
ReferenceScale scale_of(const PictureView& reference);

struct SquaredErrors {
    double rmse = 0;             // root of the mean over pixels and channels of (a - r)^2
    double relmse = 0;           // mean of (a - r)^2 / (r^2 + epsilon)
    double trimmed_relmse = 0;   // the same without the worst kTrimmed of the pixels, rounded down
    std::vector<float> squares;  // relative squared error of each pixel, mean over channels
};
inline constexpr double kTrimmed = 0.001;

/// Both of one size, not empty, all values finite. Where r^2 + epsilon is 0, the relative errors
/// are 0 or infinite.
SquaredErrors squared_errors(const PictureView& a, const PictureView& reference, double epsilon);

/// Peak signal to noise ratio in dB: infinite for equal pictures. peak > 0.
double psnr(double rmse, double peak) noexcept;

}  // namespace tessera
