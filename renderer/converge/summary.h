#pragma once
// What the runs of a series come to: their mean curve, its slopes, efficiency.

#include <optional>
#include <string>
#include <vector>

#include "renderer/converge/record.h"
#include "renderer/converge/slope.h"

namespace tessera {

enum class ErrorKind : unsigned char { relmse, rmse, flip };
inline constexpr ErrorKind kErrorKinds[] = {ErrorKind::relmse, ErrorKind::rmse, ErrorKind::flip};

const char* key_of(ErrorKind kind) noexcept;    // "relmse"
const char* title_of(ErrorKind kind) noexcept;  // "relMSE"

/// The error at a point: the true one if it is known, else its own estimate.
std::optional<double> error_at(const ConvergePoint& point, ErrorKind kind);

/// What the run says of itself there. FLIP has no estimate.
std::optional<Interval> estimate_at(const ConvergePoint& point, ErrorKind kind);

/// The seeds of a series together, where all of them have been.
struct MeanPoint {
    double spp = 0, wall_s = 0;
    Ranged error;
};

/// At the samples of the first run, and where the first of them ended; between two points of
/// another one its error is taken from the straight line in logarithms.
std::vector<MeanPoint> mean_curve(const std::vector<const ConvergeRun*>& runs, ErrorKind kind);

struct SeriesSummary {
    std::string label;
    std::vector<std::size_t> runs;  // in the scene's list, those that have points
    double spp = 0, wall_s = 0;     // at the end, means
    std::optional<double> cpu_s;
    Ranged truth[3];          // by ErrorKind; against the reference
    Ranged estimate[3];       // by itself
    bool reliable = false;    // what it says of relMSE
    Ranged wall_slope;        // of relMSE, error_at()
    Ranged spp_slope;         // likewise
    Ranged efficiency;        // 1 / (relMSE s)
    double rays_per_s = 0;    // of wall seconds
    double memory_peak = 0;   // bytes, the most of its runs
    bool comparable = false;  // against other series: its errors are true ones
};

/// In the order in which they first appear; a series whose runs have all failed is left out.
std::vector<SeriesSummary> summarise(const ConvergeScene& scene);

}  // namespace tessera
