#pragma once
// How wrong the picture is while it is rendered.

#include <vector>

#include "renderer/api/picture_error.h"
#include "renderer/film/film.h"

namespace tessera {

class Workers;

class ErrorWatch {
public:
    /// Between passes: all pixels have spp samples after so many seconds. A film without replicates
    /// says nothing.
    void look(const Film& film, Workers& workers, int spp, double wall_s, double cpu_s);

    const ErrorEstimate& latest() const noexcept { return latest_; }
    const std::vector<ErrorPoint>& curve() const noexcept { return curve_; }

private:
    ErrorEstimate latest_;
    std::vector<ErrorPoint> curve_;
};

}  // namespace tessera
