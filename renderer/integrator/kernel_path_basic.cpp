#include "renderer/integrator/kernels.h"
#include "renderer/integrator/path.h"

namespace tessera {

void path_basic(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept {
    trace_path<kBasic>(job, out, counters);
}

}  // namespace tessera
