#pragma once
// A reflection lobe about a normal of its own: the coat's.

#include "materials/lobe.h"
#include "renderer/core/frame.h"

namespace tessera {

/// frame: in the local frame of the base. Directions below either surface carry nothing.
template <class Lobe>
struct Framed {
    static constexpr bool kDelta = Lobe::kDelta;
    Lobe lobe;
    Frame frame;

    struct Lanes {
        typename Lobe::Lanes lobe;
        Vec3Lanes s, t, n;
        void set(int i, const Framed& f) {
            lobe.set(i, f.lobe);
            s.set(i, f.frame.s), t.set(i, f.frame.t), n.set(i, f.frame.n);
        }
        Framed get(int i) const { return {lobe.get(i), {s[i], t[i], n[i]}}; }
    };

    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const LobeEval e = lobe.eval(frame.to_local(wo), frame.to_local(wi));
        const bool above = wi.z > 0.0f;
        return {pick(above, e.f, Color(0.0f)), pick(above, e.pdf, 0.0f)};
    }
    LobeDirection direction(Vec3f wo, Vec2f u, float choice) const {
        LobeDirection d = lobe.direction(frame.to_local(wo), u, choice);
        const Vec3f wi = frame.to_world(d.wi);
        d.wi = pick(wi.z > 0.0f, wi, Vec3f(0.0f));
        return d;
    }
    SmoothSample sample(Vec3f wo, Vec2f u, float choice) const {
        SmoothSample s = lobe.sample(frame.to_local(wo), u, choice);
        s.to.wi = frame.to_world(s.to.wi);
        if (!(s.to.wi.z > 0.0f)) s.weight = Color(0.0f);
        return s;
    }
    template <class Child>
    void branch(Vec3f wo, Child child) const {
        child(sample(wo, {}, 0.0f));
    }
    float spread() const { return lobe.spread(); }
    Color albedo(Vec3f wo) const { return lobe.albedo(frame.to_local(wo)); }
};

}  // namespace tessera
