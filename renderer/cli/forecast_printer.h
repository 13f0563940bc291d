#pragma once
// Tells early in a render when it will be right.

#include <optional>

#include "renderer/api/picture_error.h"

namespace tessera {

class ProgressPrinter;

class ForecastPrinter {
public:
    /// target: what is forecast, if anything.
    ForecastPrinter(ProgressPrinter& printer, std::optional<ErrorTarget> target)
        : printer_(printer), target_(target) {}

    /// Says it once, as soon as it can be relied on or a tenth of the way is gone; at every look if
    /// much is to be said.
    void show(const ErrorPoint& point);

private:
    ProgressPrinter& printer_;
    std::optional<ErrorTarget> target_;
    bool said_ = false;
};

}  // namespace tessera
