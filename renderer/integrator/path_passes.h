#pragma once
// What paths owe to the passes beyond beauty. Every path carries the distribution of its throughput
// over the states of the light path automaton: where several lobes could have sent it, each takes
// its share, so that passes add up to beauty exactly and beauty's numbers are left alone.

#include <vector>

#include "materials/lobe_event.h"
#include "renderer/film/film.h"
#include "renderer/film/light_paths.h"
#include "renderer/scene/scene.h"

namespace tessera {

/// What the first surface is, apart from its lobes. d: of the camera ray; adds s's texture frame if
/// its uv are wanted.
void note_geometry(const Scene& scene, const Hit& hit, Vec3f d, bool uv, SurfacePoint& s,
                   FirstHit& out) noexcept;

/// Of one worker. Colours that are handed in are contributions to beauty, or its shares.
class PathPasses final : public EscapeSink {
public:
    PathPasses(const Scene& scene, PassSamples& out);

    /// Light that reached the camera, by the pass that takes it and the materials that sent it on.
    struct Contribution {
        int lane = 0;
        std::uint16_t pass = 0;
        int seen = kNone;  // the material before the camera
        int last = kNone;  // and the one next to the light, if it is another vertex
        Color light;
    };
    static constexpr int kNone = -1;
    /// Of other expressions than the scene's: hands out contributions and keeps no sums.
    PathPasses(const Scene& scene, const LightPaths& paths, PassSamples& out,
               std::vector<Contribution>& into);

    /// What the passes need of the path beyond states.
    bool wants_uv() const noexcept { return wants_uv_; }
    bool wants_ao() const noexcept { return wants_ao_; }
    bool wants_shadow() const noexcept { return wants_shadow_; }
    bool wants_albedos() const noexcept { return !out_.event_albedos.empty(); }
    bool wants_light() const noexcept { return into_ || !out_.light.empty(); }
    bool follows_light() const noexcept { return wants_light() || wants_shadow_; }

    void start(LaneMask lanes) noexcept;
    /// The path has come to a surface.
    void meet(int lane, int material) noexcept { met_[lane] = material; }
    FirstHit& first(int lane) noexcept { return out_.first[lane]; }
    void albedos(int lane, const EventColors& albedos) noexcept;

    /// The path is scattered: by one event, or by shares of several (any common unit).
    void scatter(int lane, LobeEvent event) noexcept;
    void scatter(int lane, const EventColors& shares) noexcept;

    /// Light at the end of the path.
    void end(int lane, LightType type, int tag, Color light) noexcept;
    void end(int lane, LightLabel label, Color light) noexcept {
        end(lane, label.type, label.tag, light);
    }

    /// A light is asked for by way of one more scattering, or of none: lit() says what came of it.
    void aim(int lane, const EventColors& shares, LightLabel light) noexcept;
    void aim_unscattered(int lane, LightLabel light) noexcept;
    void lit(int lane, Color light) noexcept {
        for (const Waiting& w : waiting_[lane]) add(w.pass, lane, light * w.share, asked_by_[lane]);
    }

    /// Gathers what escaping rays see; escaped() weighs it by their throughput.
    void see(int light, int lane, Color radiance) override {
        seen_.push_back({light, lane, radiance});
    }
    void escaped(const Vec3Lanes& throughput) noexcept;

    /// The same light, all of it and what was kept off.
    void shadow(int lane, Color light) noexcept { unblocked_[lane] = light; }
    void shadow_found(int lane, bool blocked) noexcept {
        FirstHit& f = out_.first[lane];
        f.unshadowed += unblocked_[lane];
        if (blocked) f.shadowed += unblocked_[lane];
    }

private:
    struct Branch {
        LightPaths::State state;
        Color share;  // of the throughput
    };
    struct Waiting {
        std::uint16_t pass;
        Color share;
    };
    struct Seen {
        int light, lane;
        Color radiance;
    };
    using Branches = std::vector<Branch>;
    // Materials that have sent the path on.
    struct Chain {
        int first = kNone, last = kNone;
        bool begun = false;
        Chain with(int material) const noexcept {
            return begun ? Chain{first, material, true} : Chain{material, kNone, true};
        }
    };

    void go_on(int lane) noexcept;
    static void add_branch(Branches& to, LightPaths::State state, Color share);
    void add(std::uint16_t pass, int lane, Color c, const Chain& by) noexcept {
        if (into_) return into_->push_back({lane, pass, by.first, by.last, c});
        out_.light[static_cast<std::size_t>(pass) * kLanes + static_cast<std::size_t>(lane)] += c;
    }
    void wait(int lane, LightPaths::State state, LightLabel light, Color share);

    const Scene& scene_;
    const LightPaths& paths_;
    PassSamples& out_;
    bool wants_uv_ = false, wants_ao_ = false, wants_shadow_ = false;
    Branches states_[kLanes], next_;
    std::vector<Waiting> waiting_[kLanes];
    std::vector<Seen> seen_;
    Color unblocked_[kLanes];
    bool scattered_[kLanes];
    std::vector<Contribution>* into_ = nullptr;
    int met_[kLanes];
    Chain chain_[kLanes], asked_by_[kLanes];
};

}  // namespace tessera
