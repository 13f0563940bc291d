#pragma once
// One surface point's lobes as values, for tests: lane 0 of a block. Not for several threads at
// once.

#include <cmath>
#include <optional>

#include "materials/surface/openpbr.h"

namespace tessera {

inline RoughGlass<DielectricFresnel> rough_glass(const Ggx& ggx, float eta) {
    return {{{{eta}, Color(1.0f), Color(1.0f)}, ggx, 1.0f}};
}
inline SmoothGlass<DielectricFresnel> smooth_glass(float eta) {
    return {{{eta}, Color(1.0f), Color(1.0f)}};
}
inline SmoothSheet<DielectricFresnel> smooth_sheet(float eta) {
    return {{{eta}, Color(1.0f), Color(1.0f)}};
}

struct Drawn {
    Vec3f wi;
    Color weight;
    float pdf = 0, eta = 1;
    bool delta = false;
};

class LobeProbe {
public:
    LobeProbe() = default;
    /// A lobe alone, of weight one.
    template <class Model>
    LobeProbe(const Model& model, Vec3f wo) {
        lobes_.wo.set(0, wo);
        lobes_.push(0, model, Color(1.0f));
        lobes_.prepare();
    }
    LobeProbe(const Surface& surface, Vec3f wo, bool front) {
        lobes_.wo.set(0, wo);
        View view;
        view.front = front;
        openpbr_lobes(surface, view, 0, lobes_);
        lobes_.prepare();
    }
    LobeProbe(const SurfaceParams& p, Vec3f wo, bool front) : LobeProbe(Surface(p), wo, front) {}

    bool has_extended_part() const { return (lobes_.extended() & 1u) != 0; }
    Vec3f wo() const { return lobes_.wo[0]; }
    LobeEval eval(Vec3f wi) const {
        Vec3Lanes to;
        to.set(0, wi);
        lobes_.eval(1u, to);
        return {lobes_.f(0), lobes_.pdf(0)};
    }
    std::optional<Drawn> sample(Vec2f u, float choice) const {
        SamplePairs pairs{};
        pairs.x[0] = u.x, pairs.y[0] = u.y;
        const float choices[kLanes] = {choice};
        LobeSamples s;
        if (lobes_.sample(1u, pairs, choices, s) == 0) return std::nullopt;
        return Drawn{s.wi[0], s.weight[0], s.pdf[0], s.eta[0], !(s.pdf[0] > 0.0f)};
    }

private:
    mutable AllLobes lobes_;  // evaluation writes its results into the block
};

/// The BSDF itself, green: what eval() gives has the cosine in it.
template <class Model>
double bsdf(const Model& m, Vec3f wo, Vec3f wi) {
    return static_cast<double>(m.eval(wo, wi).f.y) / std::fabs(static_cast<double>(wi.z));
}

}  // namespace tessera
