#include "renderer/converge/summary.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

// y at x on the straight line between points in logarithms; x lies within them.
double between(const std::vector<std::pair<double, double>>& points, double x) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (points[i].first == x) return points[i].second;
        if (i + 1 == points.size() || points[i + 1].first <= x) continue;
        const auto& [x0, y0] = points[i];
        const auto& [x1, y1] = points[i + 1];
        const double t = std::log(x / x0) / std::log(x1 / x0);
        return std::exp(std::log(y0) + t * std::log(y1 / y0));
    }
    return points.back().second;
}

struct Lines {
    std::vector<std::pair<double, double>> error, wall;  // by samples
};

Lines lines_of(const ConvergeRun& run, ErrorKind kind) {
    Lines out;
    for (const ConvergePoint& p : run.curve) {
        const auto e = error_at(p, kind);
        if (!e || !(*e > 0) || !std::isfinite(*e) || !(p.wall_s > 0)) continue;
        out.error.emplace_back(p.spp, *e);
        out.wall.emplace_back(p.spp, p.wall_s);
    }
    return out;
}

Ranged slope_of(const std::vector<const ConvergeRun*>& runs, bool against_wall) {
    std::vector<Ranged> slopes;
    for (const ConvergeRun* run : runs) {
        std::vector<double> x, y;
        for (const ConvergePoint& p : run->curve) {
            const auto e = error_at(p, ErrorKind::relmse);
            if (!e) continue;
            x.push_back(against_wall ? p.wall_s : p.spp);
            y.push_back(*e);
        }
        slopes.push_back(fit_slope(x, y));
    }
    return over_seeds(slopes);
}

double truth_of(const TrueError& e, ErrorKind kind) {
    return kind == ErrorKind::relmse ? e.relmse : kind == ErrorKind::rmse ? e.rmse : e.flip;
}

Ranged last_truth(const std::vector<const ConvergeRun*>& runs, ErrorKind kind) {
    std::vector<double> values;
    for (const ConvergeRun* run : runs)
        if (run->curve.back().truth) values.push_back(truth_of(*run->curve.back().truth, kind));
    return over_seeds(values);
}

// A single run's interval is the one it states.
Ranged last_estimate(const std::vector<const ConvergeRun*>& runs, ErrorKind kind) {
    std::vector<double> values;
    std::optional<Interval> only;
    for (const ConvergeRun* run : runs) {
        only = estimate_at(run->curve.back(), kind);
        if (only) values.push_back(only->value);
    }
    if (runs.size() == 1 && only) return {only->value, only->low, only->high, true, true};
    return over_seeds(values);
}

Ranged efficiency_of(const std::vector<const ConvergeRun*>& runs, const SeriesSummary& s) {
    if (runs.size() == 1 && !s.comparable && s.estimate[0].bounded) {
        const Ranged& e = s.estimate[0];
        return {1 / (e.value * s.wall_s), 1 / (e.high * s.wall_s), 1 / (e.low * s.wall_s), true,
                true};
    }
    std::vector<double> values;
    for (const ConvergeRun* run : runs)
        if (const auto e = error_at(run->curve.back(), ErrorKind::relmse))
            values.push_back(1 / (*e * run->curve.back().wall_s));
    return over_seeds(values);
}

SeriesSummary summary_of(const std::vector<const ConvergeRun*>& runs) {
    SeriesSummary s;
    s.label = runs[0]->series;
    s.comparable = s.reliable = true;
    const auto n = static_cast<double>(runs.size());
    double rays = 0, cpu = 0;
    bool all_cpu = true;
    for (const ConvergeRun* run : runs) {
        const ConvergePoint& last = run->curve.back();
        s.spp += last.spp / n, s.wall_s += last.wall_s / n;
        all_cpu = all_cpu && last.cpu_s;
        cpu += last.cpu_s.value_or(0) / n;
        rays += static_cast<double>(last.rays) / n;
        s.memory_peak = std::max(s.memory_peak, static_cast<double>(last.memory_peak));
        s.comparable = s.comparable && last.truth;
        s.reliable = s.reliable && last.relmse && last.relmse->reliable;
    }
    if (all_cpu) s.cpu_s = cpu;
    for (const ErrorKind kind : kErrorKinds) {
        s.truth[static_cast<int>(kind)] = last_truth(runs, kind);
        s.estimate[static_cast<int>(kind)] = last_estimate(runs, kind);
    }
    s.wall_slope = slope_of(runs, true);
    s.spp_slope = slope_of(runs, false);
    s.efficiency = efficiency_of(runs, s);
    s.rays_per_s = s.wall_s > 0 ? rays / s.wall_s : 0;
    return s;
}

}  // namespace

const char* key_of(ErrorKind kind) noexcept {
    return kind == ErrorKind::relmse ? "relmse" : kind == ErrorKind::rmse ? "rmse" : "flip";
}

const char* title_of(ErrorKind kind) noexcept {
    return kind == ErrorKind::relmse ? "relMSE" : kind == ErrorKind::rmse ? "RMSE" : "FLIP";
}

std::optional<double> error_at(const ConvergePoint& point, ErrorKind kind) {
    if (point.truth) return truth_of(*point.truth, kind);
    const auto own = estimate_at(point, kind);
    return own ? std::optional(own->value) : std::nullopt;
}

std::optional<Interval> estimate_at(const ConvergePoint& point, ErrorKind kind) {
    return kind == ErrorKind::relmse ? point.relmse
           : kind == ErrorKind::rmse ? point.rmse
                                     : std::nullopt;
}

std::vector<MeanPoint> mean_curve(const std::vector<const ConvergeRun*>& runs, ErrorKind kind) {
    std::vector<Lines> lines;
    double least = 0, most = HUGE_VAL;
    for (const ConvergeRun* run : runs) {
        Lines l = lines_of(*run, kind);
        if (l.error.empty()) continue;
        least = std::max(least, l.error.front().first);
        most = std::min(most, l.error.back().first);
        lines.push_back(std::move(l));
    }
    std::vector<MeanPoint> out;
    if (lines.empty()) return out;
    std::vector<double> grid;
    for (const auto& [spp, unused] : lines[0].error)
        if (spp >= least && spp <= most) grid.push_back(spp);
    // With a time to fill, seeds end at different samples.
    if (least <= most && (grid.empty() || grid.back() < most)) grid.push_back(most);
    for (const double spp : grid) {
        std::vector<double> errors;
        double wall = 0;
        for (const Lines& l : lines) {
            errors.push_back(between(l.error, spp));
            wall += between(l.wall, spp) / static_cast<double>(lines.size());
        }
        out.push_back({spp, wall, over_seeds(errors)});
    }
    return out;
}

std::vector<SeriesSummary> summarise(const ConvergeScene& scene) {
    std::vector<SeriesSummary> out;
    std::vector<std::string> seen;
    for (const ConvergeRun& first : scene.runs) {
        if (std::find(seen.begin(), seen.end(), first.series) != seen.end()) continue;
        seen.push_back(first.series);
        std::vector<std::size_t> indices;
        std::vector<const ConvergeRun*> runs;
        for (std::size_t i = 0; i < scene.runs.size(); ++i) {
            if (scene.runs[i].series != first.series || scene.runs[i].curve.empty()) continue;
            indices.push_back(i);
            runs.push_back(&scene.runs[i]);
        }
        if (runs.empty()) continue;
        out.push_back(summary_of(runs));
        out.back().runs = std::move(indices);
    }
    return out;
}

}  // namespace tessera
