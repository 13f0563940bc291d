#pragma once
// A film's coverage by names to the layers of a picture.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "renderer/film/film.h"

namespace tessera {

/// Adds what the passes of names counted. ids: of each pass, by key; notes: told what the layers
/// cannot hold.
void add_mattes(Film& film, std::span<const std::vector<std::uint32_t>> ids,
                std::vector<Layer>& layers, std::vector<std::string>& notes);

}  // namespace tessera
