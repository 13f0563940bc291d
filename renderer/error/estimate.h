#pragma once
// How wrong a picture is, from its replicates.

#include "renderer/api/picture_error.h"
#include "renderer/error/replicates.h"

namespace tessera {

class Workers;

/// Tiles of 32 pixels start at multiples of that in the frame. The same bits for any number of
/// workers.
ErrorEstimate estimate_error(const ReplicateView& picture, Workers& workers);

}  // namespace tessera
