#pragma once
// How wrong the picture is while it is rendered.

#include <optional>
#include <vector>

#include "renderer/api/picture_error.h"
#include "renderer/film/film.h"

namespace tessera {

class Workers;

class ErrorWatch {
public:
    explicit ErrorWatch(std::optional<ErrorTarget> target) : target_(target) {}

    /// Between passes: all pixels have spp samples after so many seconds. A film without replicates
    /// says nothing.
    /// Whether anything new came of it.
    bool look(const Film& film, Workers& workers, int spp, double wall_s, double cpu_s);

    /// The same of pixels that have unequally many: no point of the curve.
    void look_within(const Film& film, Workers& workers);

    /// Whether the target, if there is one, is reached.
    bool reached() const;
    /// Samples at which it will be, rounded up to whole replicates; 0: nobody knows.
    int samples_wanted() const;

    const ErrorEstimate& latest() const noexcept { return latest_; }
    const std::vector<ErrorPoint>& curve() const noexcept { return curve_; }

private:
    std::optional<ErrorTarget> target_;
    ErrorEstimate latest_;
    std::vector<ErrorPoint> curve_;
};

}  // namespace tessera
