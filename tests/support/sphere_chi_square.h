#pragma once
// Pearson's chi-square test of sampled directions against the density that is claimed for them.
//
// The sphere is cut into bins of about equal chance: rings around an axis, rings into sectors, at
// the quantiles of a pilot run with other numbers. That resolves a lobe of a thousandth of a radian
// as well as a wide one. The expected counts are the integrals of the density over the bins, by
// adaptive quadrature; directions that were not made (failed samples) are one more bin, with what
// the density lacks to one.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace tessera {

/// A part of the sphere, and the direction around which its bins lie. A density that jumps at the
/// horizon wants a hemisphere to each side: then no bin has the jump inside.
struct SphereChart {
    Vec3d axis{0, 0, 1};
    bool hemisphere = false;
    Vec3d middle{
        0, 0,
        0};  // where sectors have angle 0: keeps a small target clear of the seam; zero: anywhere
    bool holds(Vec3d w) const { return !hemisphere || dot(axis, w) > 0; }
    double end() const { return hemisphere ? 1.57079632679489662 : 3.14159265358979324; }
};

struct SphereTest {
    std::vector<SphereChart> charts;
    std::uint64_t seed = 1;
    int samples = 1 << 17;
    int rings = 16, sectors = 16;
    int min_depth =
        2;  // halvings of a bin before the quadrature may stop; more for densities with sharp edges
};

struct SphereTestResult {
    double p = 0;         // of the chi-square statistic
    double integral = 0;  // of the density over the sphere
    double failed = 0;    // share of samples that made no direction
    int bins = 0;         // after pooling
};

namespace sphere_detail {

struct Polar {
    double theta, phi;
};

class Axis {
public:
    explicit Axis(const SphereChart& chart) : n_(normalize(chart.axis)) {
        const Vec3d along = chart.middle - n_ * dot(n_, chart.middle);
        s_ = length2(along) > 0
                 ? normalize(along)
                 : normalize(cross(std::fabs(n_.z) < 0.99 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0}, n_));
        t_ = cross(n_, s_);
    }
    Polar polar(Vec3d w) const {
        const double x = dot(w, s_), y = dot(w, t_);
        return {std::atan2(std::sqrt(x * x + y * y), dot(w, n_)), std::atan2(y, x)};
    }
    Vec3d direction(Polar p) const {
        const double r = std::sin(p.theta);
        return s_ * (r * std::cos(p.phi)) + t_ * (r * std::sin(p.phi)) + n_ * std::cos(p.theta);
    }

private:
    Vec3d n_, s_, t_;
};

struct Cell {
    double theta0, theta1, phi0, phi1;
};

/// Integral of density(Polar) over the cell: 3 x 3 Gauss points, halved both ways until that
/// changes nothing.
template <class Density>
class CellIntegral {
public:
    CellIntegral(const Density& density, double tolerance, int min_depth)
        : density_(density), tolerance_(tolerance), min_depth_(min_depth) {}

    double over(const Cell& cell) const { return refine(cell, gauss(cell), tolerance_, 0); }

private:
    static constexpr int kMaxDepth = 9;

    double gauss(const Cell& c) const {
        constexpr double kNode[3] = {-0.77459666924148338, 0, 0.77459666924148338};
        constexpr double kWeight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
        const double dt = c.theta1 - c.theta0, dp = c.phi1 - c.phi0;
        double sum = 0;
        for (int i = 0; i < 3; ++i) {
            const double theta = c.theta0 + dt * 0.5 * (1 + kNode[i]);
            double row = 0;
            for (int j = 0; j < 3; ++j)
                row += kWeight[j] * density_(Polar{theta, c.phi0 + dp * 0.5 * (1 + kNode[j])});
            sum += kWeight[i] * row * std::sin(theta);
        }
        return sum * dt * dp;
    }
    double refine(const Cell& c, double coarse, double tolerance, int depth) const {
        const double tm = 0.5 * (c.theta0 + c.theta1), pm = 0.5 * (c.phi0 + c.phi1);
        const Cell parts[4] = {{c.theta0, tm, c.phi0, pm},
                               {c.theta0, tm, pm, c.phi1},
                               {tm, c.theta1, c.phi0, pm},
                               {tm, c.theta1, pm, c.phi1}};
        double fine[4], sum = 0;
        for (int i = 0; i < 4; ++i) sum += fine[i] = gauss(parts[i]);
        if (depth >= kMaxDepth || (depth >= min_depth_ && std::fabs(sum - coarse) < tolerance))
            return sum;
        sum = 0;
        // Along an edge two of the four cells go on; half the tolerance each keeps the whole within
        // it.
        for (int i = 0; i < 4; ++i) sum += refine(parts[i], fine[i], tolerance * 0.5, depth + 1);
        return sum;
    }

    const Density& density_;
    double tolerance_;
    int min_depth_;
};

/// Edges from lo to hi: `parts` quantiles of the sorted values, and beyond the outermost of them
/// steps that grow threefold, so that no cell has a narrow peak or a long tail hidden in a corner.
inline std::vector<double> graded_edges(const std::vector<double>& sorted, std::size_t parts,
                                        double lo, double hi) {
    std::vector<double> inner;
    for (std::size_t k = 1; k < parts && !sorted.empty(); ++k) {
        const double q = sorted[sorted.size() * k / parts];
        if (q > lo && q < hi && (inner.empty() || q > inner.back())) inner.push_back(q);
    }
    if (inner.size() < 2)
        return {lo, lo + 0.25 * (hi - lo), lo + 0.5 * (hi - lo), lo + 0.75 * (hi - lo), hi};
    std::vector<double> edges;
    for (double step = inner[1] - inner[0], e = inner.front() - step; e > lo; step *= 3, e -= step)
        edges.push_back(e);
    edges.push_back(lo);
    std::reverse(edges.begin(), edges.end());
    edges.insert(edges.end(), inner.begin(), inner.end());
    for (double step = inner.back() - inner[inner.size() - 2], e = inner.back() + step; e < hi;
         step *= 3, e += step)
        edges.push_back(e);
    edges.push_back(hi);
    return edges;
}

struct Ring {
    double theta1 = 0;
    std::vector<double> phi;  // edges, from -pi to pi
    int first_bin = 0;
};

class Bins {
public:
    Bins(const SphereChart& chart, std::vector<Polar> pilot, int rings, int sectors, int first_bin)
        : axis_(chart), bins_(first_bin) {
        std::sort(pilot.begin(), pilot.end(), [](Polar a, Polar b) { return a.theta < b.theta; });
        std::vector<double> theta;
        for (const Polar& p : pilot) theta.push_back(p.theta);
        const std::vector<double> edges = graded_edges(theta, std::size_t(rings), 0, chart.end());
        std::vector<double> shared = graded_edges({}, 1, -kPiD, kPiD);
        auto first = pilot.begin();
        for (std::size_t r = 1; r < edges.size(); ++r) {
            const auto last =
                std::find_if(first, pilot.end(), [&](Polar p) { return p.theta > edges[r]; });
            std::vector<double> phi;
            for (auto p = first; p != last; ++p) phi.push_back(p->phi);
            std::sort(phi.begin(), phi.end());
            // A ring with few samples is cut as its neighbour is.
            if (phi.size() >= 200) shared = graded_edges(phi, std::size_t(sectors), -kPiD, kPiD);
            first = last;
            rings_.push_back({edges[r], shared, bins_});
            bins_ += static_cast<int>(shared.size()) - 1;
        }
        // The innermost rings come before the first that has samples.
        const auto good = std::find_if(rings_.begin(), rings_.end(),
                                       [](const Ring& r) { return r.phi.size() != 5; });
        if (good == rings_.end()) return;
        for (auto r = rings_.begin(); r != good; ++r) r->phi = good->phi;
        bins_ = first_bin;
        for (Ring& r : rings_) {
            r.first_bin = bins_;
            bins_ += static_cast<int>(r.phi.size()) - 1;
        }
    }
    int end() const { return bins_; }
    int find(Vec3d w) const {
        const Polar p = axis_.polar(w);
        auto ring = std::lower_bound(rings_.begin(), rings_.end(), p.theta,
                                     [](const Ring& r, double theta) { return r.theta1 < theta; });
        if (ring == rings_.end()) --ring;
        const auto edge = std::upper_bound(ring->phi.begin() + 1, ring->phi.end() - 1, p.phi);
        return ring->first_bin + static_cast<int>(edge - ring->phi.begin()) - 1;
    }
    template <class Pdf>
    void integrate(const Pdf& pdf, int min_depth, std::vector<double>& out) const {
        const auto density = [&](Polar p) { return pdf(axis_.direction(p)); };
        double theta0 = 0;
        for (const Ring& ring : rings_) {
            // 5e-7 of 131 072 samples is a fifteenth of a count.
            const CellIntegral integral(density, 5e-7, min_depth);
            for (std::size_t s = 0; s + 1 < ring.phi.size(); ++s) {
                out[std::size_t(ring.first_bin) + s] =
                    integral.over({theta0, ring.theta1, ring.phi[s], ring.phi[s + 1]});
            }
            theta0 = ring.theta1;
        }
    }

private:
    static constexpr double kPiD = 3.14159265358979323846;
    Axis axis_;
    std::vector<Ring> rings_;
    int bins_ = 0;
};

}  // namespace sphere_detail

/// p-value of observed against expected counts; bins that expect fewer than five are pooled.
inline double pooled_chi_square_p(const std::vector<double>& observed,
                                  const std::vector<double>& expected, int* bins_out = nullptr) {
    std::vector<std::size_t> order(expected.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    double value = 0, pool_observed = 0, pool_expected = 0;
    int bins = 0;
    for (std::size_t k = 0; k < order.size(); ++k) {
        pool_observed += observed[order[k]];
        pool_expected += expected[order[k]];
        if (pool_expected < 5 && k + 1 < order.size()) continue;
        const double e = std::max(pool_expected, 1e-3);
        value += (pool_observed - e) * (pool_observed - e) / e;
        pool_observed = pool_expected = 0;
        ++bins;
    }
    if (bins_out) *bins_out = bins;
    return bins > 1 ? chi_square_p(value, bins - 1) : (value < 1e-3 ? 1.0 : 0.0);
}

/// sample(Random&) -> std::optional<Vec3d>, unit; pdf(Vec3d) -> double, per solid angle. Charts
/// must not overlap.
template <class Sample, class Pdf>
SphereTestResult sphere_chi_square(const SphereTest& test, const Sample& sample, const Pdf& pdf) {
    using namespace sphere_detail;
    const auto chart_of = [&](Vec3d w) {
        std::size_t c = 0;
        while (c < test.charts.size() && !test.charts[c].holds(w)) ++c;
        return c;
    };
    std::vector<std::vector<Polar>> pilot(test.charts.size());
    Random pilot_numbers(test.seed ^ 0x5bd1e995ull);
    for (int i = 0; i < test.samples / 4; ++i) {
        const auto w = sample(pilot_numbers);
        if (!w) continue;
        const std::size_t c = chart_of(*w);
        if (c < pilot.size()) pilot[c].push_back(Axis(test.charts[c]).polar(*w));
    }
    std::vector<Bins> bins;
    int count = 0;
    for (std::size_t c = 0; c < test.charts.size(); ++c) {
        bins.emplace_back(test.charts[c], std::move(pilot[c]), test.rings, test.sectors, count);
        count = bins.back().end();
    }
    // The last bin is for samples that failed, or fell between charts.
    std::vector<double> observed(std::size_t(count) + 1), expected(std::size_t(count) + 1);
    Random numbers(test.seed);
    for (int i = 0; i < test.samples; ++i) {
        const auto w = sample(numbers);
        const std::size_t c = w ? chart_of(*w) : bins.size();
        ++observed[c < bins.size() ? std::size_t(bins[c].find(*w)) : std::size_t(count)];
    }
    SphereTestResult result;
    for (const Bins& b : bins) b.integrate(pdf, test.min_depth, expected);
    for (double& e : expected) {
        result.integral += e;
        e *= test.samples;
    }
    expected.back() = test.samples * std::max(0.0, 1 - result.integral);
    result.failed = observed.back() / test.samples;
    result.p = pooled_chi_square_p(observed, expected, &result.bins);
    return result;
}

/// The same; where p is not above level once more with finer quadrature and the same numbers: the
/// density may have an edge that the coarse one missed. Finer quadrature only comes nearer to the
/// truth.
template <class Sample, class Pdf>
SphereTestResult sphere_chi_square_above(double level, SphereTest test, const Sample& sample,
                                         const Pdf& pdf) {
    const SphereTestResult coarse = sphere_chi_square(test, sample, pdf);
    if (coarse.p > level && std::fabs(coarse.integral + coarse.failed - 1) < 1e-3) return coarse;
    test.min_depth += 2;
    return sphere_chi_square(test, sample, pdf);
}

}  // namespace tessera
