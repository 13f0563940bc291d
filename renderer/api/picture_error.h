#pragma once
// How wrong a picture is, as it says of itself.

#include <string>
#include <vector>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// A number and between which it lies in 95 of 100 pictures, if it is reliable.
struct Interval {
    double value = 0, low = 0, high = 0;
    bool reliable = false;
};

/// Paths of one kind, from one light, by way of the same materials, and what they make of the
/// error.
struct ErrorCause {
    std::string paths;    // their kind
    std::string light;    // its name, or its group's; "" if it has none
    std::string seen;     // material that the camera sees; "": none
    std::string through;  // material next to the light, of paths with several vertices
    double share = 0;     // of the variance; all shares add up to 1, some may be below 0
    std::string remedy;   // what helps
};

/// Of a layer, against what infinitely many samples would give; over pixels and channels.
struct ErrorEstimate {
    bool asked = false;                 // false: nobody wanted to know
    bool known = false;                 // false: a pixel has fewer than four samples
    Interval rmse;                      // root of the mean squared error, in the picture's units
    Interval relmse;                    // mean of squared error / (value^2 + epsilon)
    double epsilon = 0;                 // a hundredth of the squared mean of the picture
    PixelWindow tile;                   // where the rmse is largest
    Interval worst_tile;                // the rmse there
    double calibration = 1;             // factor that is in squared errors (renderer/error)
    double largest_share = 0;           // of the squared error, in the one noisiest pixel
    std::vector<std::string> cautions;  // why something is not reliable
    std::vector<ErrorCause> causes;     // largest first; of what is not reliable, or if asked for
};

/// What a picture's error is to come down to: the upper end of its interval, reliably.
struct ErrorTarget {
    bool relative = true;  // relMSE, else RMSE
    double value = 0;
};

/// What is forecast where nothing is asked for.
inline constexpr ErrorTarget kUsualTarget{true, 0.01};

/// When a target will be reached, by the error so far. Nothing is known while value is 0.
struct ErrorForecast {
    Interval spp, wall_s;  // from the start
};

/// The error as it was at the end of a pass over the picture.
struct ErrorPoint {
    int spp = 0;
    double wall_s = 0, cpu_s = 0;  // of rendering until then
    Interval rmse, relmse;
    ErrorForecast forecast;  // of the target, where there is one
};

}  // namespace tessera
