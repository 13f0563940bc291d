#pragma once
// A picture's error as people and headers read it.

#include <string>

#include "renderer/api/image.h"
#include "renderer/api/render.h"

namespace tessera {

/// "relMSE 0.0123 (0.0118 to 0.0129), RMSE 0.041 (0.039 to 0.043)"; what is not reliable says so.
std::string to_text(const ErrorEstimate& error);

/// Logs the largest causes, and what helps against the first.
void say_causes(const std::vector<ErrorCause>& causes);

/// Of a target that was not.
std::string why_not_reached(const Statistics& stats);

/// "relMSE 0.01"
std::string to_text(const ErrorTarget& target);

/// Attributes tessera/error/... of a picture's header.
void add_error_metadata(LayeredImage& image, const ErrorEstimate& error);

}  // namespace tessera
