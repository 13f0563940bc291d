#pragma once
// The compiled kernels, one .cpp each: a row of features.h instantiated.

#include "renderer/integrator/block.h"

namespace tessera {

void path_basic(const BlockJob&, BlockSamples&, Counters&) noexcept;
void path_surface(const BlockJob&, BlockSamples&, Counters&) noexcept;
void path_full(const BlockJob&, BlockSamples&, Counters&) noexcept;
void whitted_full(const BlockJob&, BlockSamples&, Counters&) noexcept;

}  // namespace tessera
