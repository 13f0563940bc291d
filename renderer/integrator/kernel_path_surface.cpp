#include "renderer/integrator/kernels.h"
#include "renderer/integrator/path.h"

namespace tessera {

void path_surface(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept {
    trace_path<kSurface>(job, out, counters);
}

}  // namespace tessera
