#include "renderer/integrator/kernels.h"
#include "renderer/integrator/path.h"

namespace tessera {

void path_full(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept {
    trace_path<kFull>(job, out, counters);
}

}  // namespace tessera
