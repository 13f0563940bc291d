#include "renderer/integrator/error_watch.h"

#include <algorithm>
#include <cmath>

#include "renderer/error/estimate.h"
#include "renderer/error/forecast.h"

namespace tessera {
bool ErrorWatch::look(const Film& film, Workers& workers, int spp, double wall_s, double cpu_s) {
    const ReplicateView view = film.replicates();
    if (view.counts.empty()) return false;
    latest_.asked = true;
    if (spp < kReplicates) return false;
    if (!curve_.empty() && curve_.back().spp == spp) return false;
    latest_ = estimate_error(view, workers);
    if (!latest_.known) return false;
    curve_.push_back({spp, wall_s, cpu_s, latest_.rmse, latest_.relmse, {}});
    curve_.back().forecast = forecast(curve_, target_.value_or(kUsualTarget));
    return true;
}

void ErrorWatch::look_within(const Film& film, Workers& workers) {
    const ReplicateView view = film.replicates();
    if (!view.counts.empty()) latest_ = estimate_error(view, workers);
}

bool ErrorWatch::reached() const {
    return target_ && !curve_.empty() && tessera::reached(curve_.back(), *target_);
}

int ErrorWatch::samples_wanted() const {
    if (!target_ || curve_.empty()) return 0;
    const double n = std::min(curve_.back().forecast.spp.value, 1e9);
    return static_cast<int>(std::ceil(n / kReplicates)) * kReplicates;
}

}  // namespace tessera
