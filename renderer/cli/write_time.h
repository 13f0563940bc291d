#pragma once
// How long it will take to write a picture: to be kept back from the time of a render.

#include "renderer/cli/picture_files.h"
#include "renderer/scene/scene.h"

namespace tessera {

/// Seconds, judged by a strip of noise with the picture's layers, which is written beside the
/// output and removed. 0 for film files and where nothing can be written.
double foreseen_write_time(const Scene& scene, const PictureFiles& files);

}  // namespace tessera
