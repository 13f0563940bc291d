#pragma once
// How wrong a picture is, from its replicates.

#include "renderer/api/picture_error.h"
#include "renderer/error/replicates.h"

namespace tessera {

class Workers;

/// window: where the picture lies in the frame; tiles of 32 pixels start at multiples of that
/// there. The same bits for any number of workers.
ErrorEstimate estimate_error(const ReplicateView& picture, const PixelWindow& window,
                             Workers& workers);

}  // namespace tessera
