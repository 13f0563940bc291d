#include "renderer/integrator/path_passes.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tessera {
namespace {

// Shares of their sum, channel by channel; a channel that nothing has is nobody's.
EventColors normalised(const EventColors& shares) {
    Color sum(0.0f);
    for (const Color& c : shares.of) sum += c;
    const auto over = [](float a, float b) { return b > 0.0f ? a / b : 0.0f; };
    EventColors out;
    for (int e = 0; e < kLobeEvents; ++e) {
        const Color c = shares.of[e];
        out.of[e] = {over(c.x, sum.x), over(c.y, sum.y), over(c.z, sum.z)};
    }
    return out;
}

bool is_nothing(Color c) { return !(max_component(c) > 0.0f); }

}  // namespace

void note_geometry(const Scene& scene, const Hit& hit, Vec3f d, bool uv, SurfacePoint& s,
                   FirstHit& out) noexcept {
    out.hit = true;
    out.z = scene.camera().depth(s.p);
    out.p = Vec3f(Vec3d(s.p) + scene.origin());
    out.pref = scene.geometry().placements[s.placement].to_object.point(s.p);
    out.n = dot(s.ns, d) <= 0.0f ? s.ns : -s.ns;
    out.ng = dot(s.ng, d) <= 0.0f ? s.ng : -s.ng;
    out.facing = std::min(std::fabs(dot(s.ns, d)), 1.0f);
    if (const NameIds* names = scene.name_ids()) {
        const NameKeys keys = names->keys(scene.geometry(), s);
        out.object = keys[0] + 1, out.material = keys[1] + 1, out.asset = keys[2] + 1;
    }
    if (!uv) return;
    add_texture_frame(scene.geometry(), hit, s);
    out.uv = s.uv;
    out.has_uv = length2(s.dpdu) > 0.0f;
}

PathPasses::PathPasses(const Scene& scene, PassSamples& out)
    : scene_(scene), paths_(scene.light_paths()), out_(out) {
    for (const Pass& p : scene.passes()) {
        wants_uv_ |= p.source == PassSource::uv;
        wants_ao_ |= p.source == PassSource::ao;
        wants_shadow_ |= p.source == PassSource::shadow || p.source == PassSource::shadow_matte;
    }
}

PathPasses::PathPasses(const Scene& scene, const LightPaths& paths, PassSamples& out,
                       std::vector<Contribution>& into)
    : scene_(scene), paths_(paths), out_(out), into_(&into) {}

void PathPasses::start(LaneMask lanes) noexcept {
    out_.clear();
    seen_.clear();
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        states_[i].clear();
        waiting_[i].clear();
        scattered_[i] = false;
        met_[i] = kNone;
        chain_[i] = {};
        add_branch(states_[i], paths_.start(), Color(1.0f));
    }
}

void PathPasses::albedos(int lane, const EventColors& albedos) noexcept {
    for (int e = 0; e < kLobeEvents; ++e) {
        const int at = e * kLanes + lane;
        out_.event_albedos[static_cast<std::size_t>(at)] = albedos.of[e];
    }
}

void PathPasses::add_branch(Branches& to, LightPaths::State state, Color share) {
    if (state == LightPaths::kDead || is_nothing(share)) return;
    const auto it =
        std::find_if(to.begin(), to.end(), [&](const Branch& b) { return b.state == state; });
    if (it == to.end())
        to.push_back({state, share});
    else
        it->share += share;
}

void PathPasses::scatter(int lane, LobeEvent event) noexcept {
    next_.clear();
    for (const Branch& b : states_[lane]) add_branch(next_, paths_.after(b.state, event), b.share);
    go_on(lane);
}

void PathPasses::go_on(int lane) noexcept {
    states_[lane].swap(next_);
    scattered_[lane] = true;
    chain_[lane] = chain_[lane].with(met_[lane]);
}

void PathPasses::scatter(int lane, const EventColors& shares) noexcept {
    next_.clear();
    const EventColors part = normalised(shares);
    for (int e = 0; e < kLobeEvents; ++e) {
        if (is_nothing(part.of[e])) continue;
        for (const Branch& b : states_[lane])
            add_branch(next_, paths_.after(b.state, static_cast<LobeEvent>(e)),
                       b.share * part.of[e]);
    }
    go_on(lane);
}

void PathPasses::end(int lane, LightType type, int tag, Color light) noexcept {
    if (type == LightType::surroundings && !scattered_[lane]) type = LightType::background;
    const Chain& chain = chain_[lane];
    const Chain by = chain.begun ? chain : chain.with(met_[lane]);
    for (const Branch& b : states_[lane]) {
        for (const std::uint16_t pass : paths_.taking(b.state, type, tag))
            add(pass, lane, light * b.share, by);
    }
}

void PathPasses::wait(int lane, LightPaths::State state, LightLabel light, Color share) {
    for (const std::uint16_t pass : paths_.taking(state, light.type, light.tag)) {
        auto& list = waiting_[lane];
        const auto it = std::find_if(list.begin(), list.end(),
                                     [&](const Waiting& w) { return w.pass == pass; });
        if (it == list.end())
            list.push_back({pass, share});
        else
            it->share += share;
    }
}

void PathPasses::aim(int lane, const EventColors& shares, LightLabel light) noexcept {
    waiting_[lane].clear();
    asked_by_[lane] = chain_[lane].with(met_[lane]);
    const EventColors part = normalised(shares);
    for (int e = 0; e < kLobeEvents; ++e) {
        if (is_nothing(part.of[e])) continue;
        for (const Branch& b : states_[lane]) {
            const LightPaths::State s = paths_.after(b.state, static_cast<LobeEvent>(e));
            if (s != LightPaths::kDead) wait(lane, s, light, b.share * part.of[e]);
        }
    }
}

void PathPasses::aim_unscattered(int lane, LightLabel light) noexcept {
    waiting_[lane].clear();
    asked_by_[lane] = chain_[lane].with(met_[lane]);
    for (const Branch& b : states_[lane]) wait(lane, b.state, light, b.share);
}

void PathPasses::escaped(const Vec3Lanes& throughput) noexcept {
    for (const Seen& s : seen_)
        end(s.lane, scene_.lights().label(s.light), throughput[s.lane] * s.radiance);
    seen_.clear();
}

}  // namespace tessera
