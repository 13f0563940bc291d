#include "renderer/integrator/kernels.h"
#include "renderer/integrator/whitted.h"

namespace tessera {

void whitted_full(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept {
    WhittedBlock<kFull>(job, out, counters).trace();
}

}  // namespace tessera
