#pragma once
// When the error will have come down to a target.

#include <vector>

#include "renderer/api/picture_error.h"

namespace tessera {

/// The error that a target is about.
const Interval& of_target(const ErrorPoint& point, const ErrorTarget& target);

/// Whether the error is reliably no more than the target.
bool reached(const ErrorPoint& point, const ErrorTarget& target);

/// From the latest point on a power of the samples, whose exponent is -1.1 for squared errors
/// unless the curve says otherwise, and seconds in proportion to samples, as many as lately.
ErrorForecast forecast(const std::vector<ErrorPoint>& curve, const ErrorTarget& target);

}  // namespace tessera
