#include "renderer/integrator/kernels.h"

namespace tessera {

BlockKernel find_kernel(Integrator integrator, std::string_view name) {
    if (integrator == Integrator::whitted) return whitted_full;
    if (name == "basic") return path_basic;
    if (name == "surface") return path_surface;
    return path_full;
}

}  // namespace tessera
