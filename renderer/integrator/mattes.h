#pragma once
// A film's coverage by names to the layers and the header of a picture.

#include <string>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/scene/scene.h"

namespace tessera {

/// Adds what the passes of names counted. notes: told what the layers cannot hold.
void add_mattes(const Scene& scene, Film& film, LayeredImage& image,
                std::vector<std::string>& notes);

}  // namespace tessera
