#pragma once
// How far the replicates' errors are from the picture's, by the probes.
//
// Four runs of a sequence keep out of each other's way: the mean of all is better than that of four
// that know nothing of each other, by how much depends on the scene. A probe has a second sequence
// as long as the whole, and half the squared difference of the two is free of that: over all probes
// it says by what factor the replicates' errors, which every pixel has, are to be multiplied.

#include "renderer/error/replicates.h"
#include "renderer/error/tile_error.h"

namespace tessera {

struct Calibration {
    struct Factor {
        double value = 1, spread = 0;  // and the variance of its logarithm
    };
    Factor squared, relative;
    int probes = 0;  // that it stands on
};

/// all: of the picture, with the same epsilon of relative errors.
Calibration calibrate(const ReplicateView& picture, const TileError& all, double epsilon);

}  // namespace tessera
