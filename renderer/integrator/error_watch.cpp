#include "renderer/integrator/error_watch.h"

#include "renderer/error/estimate.h"

namespace tessera {

void ErrorWatch::look(const Film& film, Workers& workers, int spp, double wall_s, double cpu_s) {
    const ReplicateView view = film.replicates();
    if (view.counts.empty()) return;
    latest_.asked = true;
    if (spp < kReplicates) return;
    if (!curve_.empty() && curve_.back().spp == spp) return;
    latest_ = estimate_error(view, film.window(), workers);
    if (latest_.known) curve_.push_back({spp, wall_s, cpu_s, latest_.rmse, latest_.relmse});
}

}  // namespace tessera
