#include "renderer/cli/forecast_printer.h"

#include <fmt/format.h>

#include "renderer/cli/progress.h"
#include "renderer/cli/say_error.h"
#include "renderer/core/log.h"

namespace tessera {
namespace {

constexpr double kShare = 0.05;  // of the way, before which nothing is said

}  // namespace

void ForecastPrinter::show(const ErrorPoint& p) {
    log_verbose(
        fmt::format("error    {} spp, {:.3g} s: relMSE {:.3g} ({:.3g} to {:.3g}), RMSE {:.3g} "
                    "({:.3g} to {:.3g})",
                    p.spp, p.wall_s, p.relmse.value, p.relmse.low, p.relmse.high, p.rmse.value,
                    p.rmse.low, p.rmse.high));
    const Interval &spp = p.forecast.spp, &s = p.forecast.wall_s;
    if (said_ || !target_ || !(s.value > 0) || p.wall_s < kShare * s.value) return;
    said_ = true;
    printer_.info(fmt::format(
        "error    {} takes about {:.0f} spp and {:.3g} s ({:.3g} to {:.3g} s){}", to_text(*target_),
        spp.value, s.value, s.low, s.high, s.reliable ? "" : "; unreliable"));
}

}  // namespace tessera
