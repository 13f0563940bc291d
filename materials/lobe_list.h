#pragma once
// The lobes of one surface point, on the stack: which there are, with what weight and chance.

#include <new>
#include <type_traits>
#include <variant>

#include "materials/lobes/diffuse.h"
#include "materials/lobes/glass.h"
#include "materials/lobes/reflection.h"

namespace tessera {

using LobeModel = std::variant<DiffuseLobe, RoughReflection<DielectricFresnel>,
                               RoughReflection<MetalFresnel>, SmoothReflection<DielectricFresnel>,
                               SmoothReflection<MetalFresnel>, RoughGlass, SmoothGlass, ThinGlass>;

struct Lobe {
    LobeModel model;
    Color weight;
    float pick = 0;  // probability
    bool delta = false;
};

class LobeList {
public:
    static constexpr int kCapacity = 4;

    /// Lobes of no weight are not kept; beyond the capacity nothing is (the surface builders stay
    /// within it).
    template <class Model>
    void push(const Model& model, Color weight) {
        if (!(max_component(weight) > 0.0f) || size_ == kCapacity) return;
        new (&slots_[size_++].lobe) Lobe{model, weight, 0.0f, Model::kDelta};
    }
    /// Fixes the chances: in proportion to what each lobe gives back toward wo.
    void prepare(Vec3f wo) noexcept;

    bool empty() const noexcept { return size_ == 0; }
    int size() const noexcept { return size_; }
    const Lobe& operator[](int i) const noexcept { return slots_[i].lobe; }
    bool has_smooth_part() const noexcept;    // some lobe is a delta
    bool has_extended_part() const noexcept;  // some lobe is not

    /// All lobes that are not deltas, with the density of sample().
    LobeEval eval(Vec3f wo, Vec3f wi) const noexcept;
    /// choice picks the lobe (and within it), u the direction.
    bool sample(Vec3f wo, Vec2f u, float choice, LobeSample& out) const noexcept;
    /// Directional albedo toward wo, roughly; for the albedo pass.
    Color albedo(Vec3f wo) const noexcept;

private:
    // Slots start empty: setting up lobes that are never pushed cost more than the pushing.
    union Slot {
        Slot() {}
        Lobe lobe;
    };
    static_assert(std::is_trivially_destructible_v<Lobe> && std::is_trivially_copyable_v<Lobe>);
    Slot slots_[kCapacity];
    int size_ = 0;
};

// In the header: measured, the loop's hottest leaves.

inline void LobeList::prepare(Vec3f wo) noexcept {
    if (size_ == 1) {
        slots_[0].lobe.pick = 1.0f;
        return;
    }
    float sum = 0;
    for (int i = 0; i < size_; ++i) {
        Lobe& lobe = slots_[i].lobe;
        const Color albedo = std::visit([&](const auto& m) { return m.albedo(wo); }, lobe.model);
        lobe.pick = max_component(lobe.weight * albedo);
        sum += lobe.pick;
    }
    const float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    for (int i = 0; i < size_; ++i)
        slots_[i].lobe.pick =
            sum > 0.0f ? slots_[i].lobe.pick * scale : 1.0f / static_cast<float>(size_);
}

inline bool LobeList::has_smooth_part() const noexcept {
    for (int i = 0; i < size_; ++i) {
        if (slots_[i].lobe.delta) return true;
    }
    return false;
}

inline bool LobeList::has_extended_part() const noexcept {
    for (int i = 0; i < size_; ++i) {
        if (!slots_[i].lobe.delta) return true;
    }
    return false;
}

inline LobeEval LobeList::eval(Vec3f wo, Vec3f wi) const noexcept {
    LobeEval sum;
    for (int i = 0; i < size_; ++i) {
        const Lobe& lobe = slots_[i].lobe;
        if (lobe.delta) continue;
        const LobeEval e = std::visit([&](const auto& m) { return m.eval(wo, wi); }, lobe.model);
        sum.f += e.f * lobe.weight;
        sum.pdf += e.pdf * lobe.pick;
    }
    return sum;
}

inline bool LobeList::sample(Vec3f wo, Vec2f u, float choice, LobeSample& out) const noexcept {
    if (size_ == 0) return false;
    int chosen = 0;
    float below = 0;
    while (chosen < size_ - 1 && choice >= below + slots_[chosen].lobe.pick)
        below += slots_[chosen++].lobe.pick;
    const Lobe& lobe = slots_[chosen].lobe;
    if (!(lobe.pick > 0.0f)) return false;
    const float rest = size_ == 1 ? choice : std::min((choice - below) / lobe.pick, 0x1.fffffep-1f);
    if (size_ == 1 || lobe.delta) {
        if (!std::visit([&](const auto& m) { return m.sample(wo, u, rest, out); }, lobe.model))
            return false;
        out.weight *= size_ == 1 ? lobe.weight : lobe.weight * (1.0f / lobe.pick);
        return true;
    }
    // Several lobes can make this direction: the balance of all of them, not of the one that did.
    const auto direction = [&](const auto& m) {
        if constexpr (std::remove_cvref_t<decltype(m)>::kDelta) {
            return false;
        } else {
            return m.direction(wo, u, rest, out);
        }
    };
    if (!std::visit(direction, lobe.model)) return false;
    const LobeEval all = eval(wo, out.wi);
    if (!(all.pdf > 0.0f)) return false;
    out.weight = all.f / all.pdf;
    out.pdf = all.pdf;
    return true;
}

inline Color LobeList::albedo(Vec3f wo) const noexcept {
    Color sum(0.0f);
    for (int i = 0; i < size_; ++i) {
        sum += slots_[i].lobe.weight *
               std::visit([&](const auto& m) { return m.albedo(wo); }, slots_[i].lobe.model);
    }
    return sum;
}

}  // namespace tessera
