#pragma once
// The lobes of one surface point, on the stack: which there are, with what weight and chance.

#include <variant>

#include "materials/lobes/diffuse.h"
#include "materials/lobes/glass.h"
#include "materials/lobes/reflection.h"

namespace tessera {

using LobeModel = std::variant<DiffuseLobe, RoughReflection<DielectricFresnel>, RoughReflection<MetalFresnel>,
                               SmoothReflection<DielectricFresnel>, SmoothReflection<MetalFresnel>, RoughGlass,
                               SmoothGlass, ThinGlass>;

struct Lobe {
    LobeModel model;
    Color weight;
    float pick = 0;  // probability
    bool delta = false;
};

class LobeList {
public:
    static constexpr int kCapacity = 4;

    /// Lobes of no weight are not kept; beyond the capacity nothing is (the surface builders stay within it).
    template <class Model>
    void push(const Model& model, Color weight) {
        if (!(max_component(weight) > 0.0f) || size_ == kCapacity) return;
        lobes_[size_++] = {model, weight, 0.0f, Model::kDelta};
    }
    /// Fixes the chances: in proportion to what each lobe gives back toward wo.
    void prepare(Vec3f wo) noexcept;

    bool empty() const noexcept { return size_ == 0; }
    int size() const noexcept { return size_; }
    const Lobe& operator[](int i) const noexcept { return lobes_[i]; }
    bool has_smooth_part() const noexcept;     // some lobe is a delta
    bool has_extended_part() const noexcept;   // some lobe is not

    /// All lobes that are not deltas, with the density of sample().
    LobeEval eval(Vec3f wo, Vec3f wi) const noexcept;
    /// choice picks the lobe (and within it), u the direction.
    std::optional<LobeSample> sample(Vec3f wo, Vec2f u, float choice) const noexcept;
    /// Directional albedo toward wo, roughly; for the albedo pass.
    Color albedo(Vec3f wo) const noexcept;

private:
    Lobe lobes_[kCapacity];
    int size_ = 0;
};

}  // namespace tessera
