#pragma once
// The lobes of sixteen surface points: which there are, with what weight and chance. They are kept
// by kind, so that what all points of a block do alike runs over all of them at once.

#include <bit>
#include <tuple>

#include "materials/lobe_event.h"
#include "materials/terminator.h"
#include "renderer/core/sampler.h"

namespace tessera {

/// Where sixteen paths go on from their surfaces, and what they carry there.
struct LobeSamples {
    Vec3Lanes wi;
    Vec3Lanes weight;           // f / pdf; of a smooth lobe the whole ratio
    float pdf[kLanes];          // 0: of a smooth lobe
    float eta[kLanes];          // index on wi's side over wo's side; 1 unless refracted
    float spread[kLanes];       // half angle by which the ray cone grows
    std::uint32_t cls[kLanes];  // LobeClass
};

template <class Model>
struct LobesOfKind {
    using Kind = Model;
    typename Model::Lanes model;
    LaneMask lanes = 0;         // those that have such a lobe
    float chance[kLanes] = {};  // of its being sampled; 0: the lane has none
    Vec3Lanes weight;

    LobesOfKind() noexcept {}  // a tuple would clear all of it
};

/// Models: the kinds that there can be; a point has at most one lobe of each.
template <class... Models>
class LobeBlock {
public:
    template <class Model>
    static constexpr bool kHas = (std::is_same_v<Model, Models> || ...);

    Vec3Lanes wo;    // toward the viewers, local
    Vec3Lanes even;  // normals of the surface without its bumps, local; at first those of the frame

    LobeBlock() noexcept {
        for (int i = 0; i < kLanes; ++i) even.set(i, {0.0f, 0.0f, 1.0f});
    }

    /// No lane has a lobe.
    void clear() noexcept {
        extended_ = smooth_ = 0;
        each_kind([](auto& kind) {
            if (kind.lanes == 0) return;
            kind.lanes = 0;
            for (float& c : kind.chance) c = 0.0f;
        });
    }
    /// Adds a lobe seen from wo[lane], unless its weight is nothing.
    template <class Model>
    void push(int lane, const Model& lobe, Color weight) noexcept {
        const float most = max_component(weight);
        if (!(most > 0.0f)) return;
        auto& kind = std::get<LobesOfKind<Model>>(kinds_);
        kind.model.set(lane, lobe);
        kind.weight.set(lane, weight);
        // A black lobe is kept: it may not be black elsewhere.
        kind.chance[lane] = std::max(max_component(weight * lobe.albedo(wo[lane])), 1e-6f * most);
        kind.lanes |= 1u << lane;
        (Model::kDelta ? smooth_ : extended_) |= 1u << lane;
    }
    /// After the last push: makes the chances add up to one.
    void prepare() noexcept {
        float sum[kLanes] = {};
        each_kind([&](auto& kind) {
            if (kind.lanes == 0) return;
            for (int i = 0; i < kLanes; ++i) sum[i] += kind.chance[i];
        });
        for (float& s : sum) s = std::max(s, 1e-30f);
        each_kind([&](auto& kind) {
            if (kind.lanes == 0) return;
            for (int i = 0; i < kLanes; ++i) kind.chance[i] /= sum[i];
        });
    }

    LaneMask extended() const noexcept {
        return extended_;
    }  // lanes with a lobe that is not smooth
    LaneMask smooth() const noexcept { return smooth_; }

    /// Of all lobes that are not smooth: the value towards wi, and the density of sample() there.
    void eval(LaneMask lanes, const Vec3Lanes& wi) noexcept {
        wi_ = wi;
        for (int i = 0; i < kLanes; ++i) f_.set(i, Color(0.0f)), pdf_[i] = 0.0f;
        each_kind([&](auto& kind) {
            using Model = typename std::remove_reference_t<decltype(kind)>::Kind;
            if constexpr (!Model::kDelta) {
                if ((lanes & kind.lanes) != 0) add_values<Model>(lanes & kind.lanes);
            }
        });
    }
    Color f(int lane) const noexcept { return f_[lane]; }
    float pdf(int lane) const noexcept { return pdf_[lane]; }

    /// choice picks the lobe (and within it), u the direction. Returns the lanes that have a
    /// sample.
    LaneMask sample(LaneMask lanes, const SamplePairs& u, const float (&choice)[kLanes],
                    LobeSamples& out) noexcept {
        lanes &= extended_ | smooth_;
        choose(choice);
        LaneMask bounced = 0;
        each_kind([&](auto& kind) {
            using Model = typename std::remove_reference_t<decltype(kind)>::Kind;
            const LaneMask mine = kind.lanes & chosen(number_of(kind)) & lanes;
            if (mine == 0) return;
            if constexpr (Model::kDelta) {
                bounced |= mine;
                each(mine, [&](int i) { set_smooth(i, kind, u.at(i), out); });
            } else {
                set_directions<Model>(mine, kind, u, out);
            }
        });
        return (bounced | weigh(lanes & ~bounced, out)) & lanes;
    }

    /// Of one lane's specular lobes alone, or of its others, as eval().
    LobeEval eval(int lane, Vec3f wi, bool specular) const noexcept {
        LobeEval sum;
        each_kind([&](const auto& kind) {
            using Model = typename std::remove_cvref_t<decltype(kind)>::Kind;
            if constexpr (!Model::kDelta) {
                if (specular == kMatte<Model> || !(kind.chance[lane] > 0.0f)) return;
                const LobeEval e = share<Model>(kind, lane, wi);
                sum.f += e.f;
                sum.pdf += e.pdf;
            }
        });
        return sum;
    }
    /// Whether sample() took a specular lobe.
    bool took_specular(int lane) const noexcept {
        constexpr bool kSpecular[] = {!kMatte<Models>...};
        return chosen_[lane] < sizeof...(Models) && kSpecular[chosen_[lane]];
    }

    /// Directional albedo toward wo, roughly; for the albedo pass.
    Color albedo(int lane) const noexcept {
        Color sum(0.0f);
        each_kind([&](const auto& kind) {
            if (kind.chance[lane] > 0.0f)
                sum += kind.weight[lane] * kind.model.get(lane).albedo(wo[lane]);
        });
        return sum;
    }
    /// Values towards wi of a lane's lobes that are not smooth, by event.
    EventColors values(int lane, Vec3f wi, LobePart part) const noexcept {
        EventColors out;
        each_kind([&](const auto& kind) {
            using Model = typename std::remove_cvref_t<decltype(kind)>::Kind;
            if constexpr (!Model::kDelta) {
                if (!(kind.chance[lane] > 0.0f)) return;
                if (part != LobePart::all && kMatte<Model> != (part == LobePart::matte)) return;
                out[event_of<Model>(wi.z < 0.0f)] += share<Model>(kind, lane, wi).f;
            }
        });
        return out;
    }
    /// The event of the lobe that sample() took, which sent the path towards wi.
    LobeEvent taken_event(int lane, Vec3f wi) const noexcept {
        LobeEvent event = LobeEvent::diffuse;
        each_kind([&](const auto& kind) {
            using Model = typename std::remove_cvref_t<decltype(kind)>::Kind;
            if (number_of(kind) == chosen_[lane]) event = event_of<Model>(wi.z < 0.0f);
        });
        return event;
    }
    /// As albedo(), by event.
    EventColors albedos(int lane) const noexcept {
        EventColors out;
        each_kind([&](const auto& kind) {
            using Model = typename std::remove_cvref_t<decltype(kind)>::Kind;
            if (!(kind.chance[lane] > 0.0f)) return;
            const Model model = kind.model.get(lane);
            Color through = model.albedo(wo[lane]);
            if constexpr (lobe_events::kThrough<Model>) {
                const Color reflected = model.reflected_albedo(wo[lane]);
                out[event_of<Model>(false)] += kind.weight[lane] * reflected;
                through = through - reflected;
            }
            out[event_of<Model>(true)] += kind.weight[lane] * through;
        });
        return out;
    }
    /// Weight of a lane's lobe of one kind.
    template <class Model>
    Color weight(int lane) const noexcept {
        const auto& kind = std::get<LobesOfKind<Model>>(kinds_);
        return kind.chance[lane] > 0.0f ? kind.weight[lane] : Color(0.0f);
    }
    /// Calls child(SmoothSample, weight) for every direction of a lane's smooth lobes.
    template <class Child>
    void branch(int lane, Child child) const noexcept {
        each_kind([&](const auto& kind) {
            using Model = typename std::remove_cvref_t<decltype(kind)>::Kind;
            if constexpr (Model::kDelta) {
                if (!(kind.chance[lane] > 0.0f)) return;
                kind.model.get(lane).branch(
                    wo[lane], [&](const SmoothSample& s) { child(s, kind.weight[lane]); });
            }
        });
    }

private:
    // Up to so many lanes are cheaper one by one.
    static constexpr int kFew = 2;

    template <class Function>
    void each_kind(Function f) {
        std::apply([&](auto&... kind) { (f(kind), ...); }, kinds_);
    }
    template <class Function>
    void each_kind(Function f) const {
        std::apply([&](const auto&... kind) { (f(kind), ...); }, kinds_);
    }
    template <class Function>
    static void each(LaneMask lanes, Function f) {
        for (; lanes != 0; lanes &= lanes - 1) f(std::countr_zero(lanes));
    }
    // All lanes at once, or the few alone; f may be called for lanes that are not asked for.
    template <class Function>
    static void all_or_few(LaneMask lanes, Function f) {
        if (std::popcount(lanes) <= kFew) return each(lanes, f);
        for (int i = 0; i < kLanes; ++i) f(i);
    }

    template <class Model>
    [[gnu::flatten]] void add_values(LaneMask lanes) noexcept {
        const auto& kind = std::get<LobesOfKind<Model>>(kinds_);
        all_or_few(lanes, [&](int i) {
            const LobeEval e = share<Model>(kind, i, wi_[i]);
            const bool there = kind.chance[i] > 0.0f;
            const Color f = e.f + f_[i];
            f_.set(i, pick(there, f, f_[i]));
            pdf_[i] = pick(there, pdf_[i] + e.pdf, pdf_[i]);
        });
    }
    // What one kind adds to a lane's value and density.
    template <class Model>
    LobeEval share(const LobesOfKind<Model>& kind, int i, Vec3f wi) const noexcept {
        const LobeEval e = kind.model.get(i).eval(wo[i], wi);
        Color f = e.f * kind.weight[i];
        if constexpr (requires { Model::kDiffuse; }) f *= softened_terminator(even[i], wi);
        return {f, e.pdf * kind.chance[i]};
    }

    // The last kind at or above whose lower bound the choice lies; the rest is stretched to [0, 1).
    void choose(const float (&choice)[kLanes]) noexcept {
        float below[kLanes];
        for (int i = 0; i < kLanes; ++i) below[i] = 0.0f, rest_[i] = choice[i], chosen_[i] = kNone;
        each_kind([&](const auto& kind) {
            if (kind.lanes != 0) choose_kind(kind.chance, number_of(kind), choice, below);
        });
    }
    void choose_kind(const float (&chance)[kLanes], std::uint32_t number,
                     const float (&choice)[kLanes], float (&below)[kLanes]) noexcept {
        for (int i = 0; i < kLanes; ++i) {
            const bool here = (chance[i] > 0.0f) & (choice[i] >= below[i]);
            const float rest = std::min((choice[i] - below[i]) / chance[i], 0x1.fffffep-1f);
            rest_[i] = pick(here, rest, rest_[i]);
            chosen_[i] = here ? number : chosen_[i];
            below[i] += chance[i];
        }
    }
    template <class Model>
    static constexpr std::uint32_t number_of(const LobesOfKind<Model>&) {
        std::uint32_t number = 0;
        (void)((std::is_same_v<Model, Models> || (++number, false)) || ...);
        return number;
    }
    LaneMask chosen(std::uint32_t number) const noexcept {
        LaneFlags flags;
        for (int i = 0; i < kLanes; ++i) flags.is[i] = chosen_[i] == number;
        return flags.mask();
    }

    template <class Model>
    void set_smooth(int i, const LobesOfKind<Model>& kind, Vec2f u, LobeSamples& out) noexcept {
        const SmoothSample s = kind.model.get(i).sample(wo[i], u, rest_[i]);
        out.wi.set(i, s.to.wi);
        out.weight.set(i, s.weight * kind.weight[i] * (1.0f / kind.chance[i]));
        out.pdf[i] = 0.0f;
        out.eta[i] = s.to.eta;
        out.spread[i] = 0.0f;
        out.cls[i] = static_cast<std::uint32_t>(s.to.cls);
    }

    template <class Model>
    [[gnu::flatten]] void set_directions(LaneMask lanes, const LobesOfKind<Model>& kind,
                                         const SamplePairs& u, LobeSamples& out) noexcept {
        const LaneFlags mine = flags_of(lanes);
        all_or_few(lanes, [&](int i) {
            const Model lobe = kind.model.get(i);
            const LobeDirection to = lobe.direction(wo[i], u.at(i), rest_[i]);
            const bool here = mine.is[i] != 0;
            out.wi.set(i, pick(here, to.wi, out.wi[i]));
            out.eta[i] = pick(here, to.eta, out.eta[i]);
            out.spread[i] = pick(here, lobe.spread(), out.spread[i]);
            out.cls[i] = here ? static_cast<std::uint32_t>(to.cls) : out.cls[i];
        });
    }

    // Several lobes can make a direction: the balance of all of them, not of the one that did.
    LaneMask weigh(LaneMask lanes, LobeSamples& out) noexcept {
        if (lanes == 0) return 0;
        eval(lanes, out.wi);
        LaneFlags there;
        const LaneFlags mine = flags_of(lanes);
        for (int i = 0; i < kLanes; ++i) {
            const bool here = mine.is[i] != 0;
            there.is[i] = pdf_[i] > 0.0f;
            out.weight.set(i, pick(here, f_[i] / pdf_[i], out.weight[i]));
            out.pdf[i] = pick(here, pdf_[i], out.pdf[i]);
        }
        return there.mask();
    }

    std::tuple<LobesOfKind<Models>...> kinds_;
    LaneMask extended_ = 0, smooth_ = 0;
    Vec3Lanes wi_, f_;
    float pdf_[kLanes], rest_[kLanes];
    std::uint32_t chosen_[kLanes];
};

/// Those of a kernel: what a scene cannot have is not there.
using DiffuseLobes = LobeBlock<DiffuseLobe>;
using OpaqueLobes =
    LobeBlock<DiffuseLobe, RoughReflection<DielectricFresnel>, RoughReflection<MetalFresnel>,
              SmoothReflection<DielectricFresnel>, SmoothReflection<MetalFresnel>>;
using AllLobes = LobeBlock<
    DiffuseLobe, RoughReflection<DielectricFresnel>, RoughReflection<MetalFresnel>,
    SmoothReflection<DielectricFresnel>, SmoothReflection<MetalFresnel>, EonLobe, FuzzLobe,
    Framed<RoughReflection<DielectricFresnel>>, Framed<SmoothReflection<DielectricFresnel>>,
    RoughReflection<FilmFresnel>, SmoothReflection<FilmFresnel>, DiffuseTransmission,
    SubsurfaceEntry, RoughGlass<DielectricFresnel>, SmoothGlass<DielectricFresnel>,
    RoughSheet<DielectricFresnel>, SmoothSheet<DielectricFresnel>, RoughGlass<FilmFresnel>,
    SmoothGlass<FilmFresnel>, RoughSheet<FilmFresnel>, SmoothSheet<FilmFresnel>>;

}  // namespace tessera
