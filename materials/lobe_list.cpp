#include "materials/lobe_list.h"

namespace tessera {

void LobeList::prepare(Vec3f wo) noexcept {
    if (size_ == 1) {
        lobes_[0].pick = 1.0f;
        return;
    }
    float sum = 0;
    for (int i = 0; i < size_; ++i) {
        Lobe& lobe = lobes_[i];
        const Color albedo = std::visit([&](const auto& m) { return m.albedo(wo); }, lobe.model);
        lobe.pick = max_component(lobe.weight * albedo);
        sum += lobe.pick;
    }
    const float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
    for (int i = 0; i < size_; ++i) lobes_[i].pick = sum > 0.0f ? lobes_[i].pick * scale : 1.0f / static_cast<float>(size_);
}

bool LobeList::has_smooth_part() const noexcept {
    for (int i = 0; i < size_; ++i) {
        if (lobes_[i].delta) return true;
    }
    return false;
}

bool LobeList::has_extended_part() const noexcept {
    for (int i = 0; i < size_; ++i) {
        if (!lobes_[i].delta) return true;
    }
    return false;
}

LobeEval LobeList::eval(Vec3f wo, Vec3f wi) const noexcept {
    LobeEval sum;
    for (int i = 0; i < size_; ++i) {
        const Lobe& lobe = lobes_[i];
        if (lobe.delta) continue;
        const LobeEval e = std::visit([&](const auto& m) { return m.eval(wo, wi); }, lobe.model);
        sum.f += e.f * lobe.weight;
        sum.pdf += e.pdf * lobe.pick;
    }
    return sum;
}

std::optional<LobeSample> LobeList::sample(Vec3f wo, Vec2f u, float choice) const noexcept {
    if (size_ == 0) return std::nullopt;
    int chosen = 0;
    float below = 0;
    while (chosen < size_ - 1 && choice >= below + lobes_[chosen].pick) below += lobes_[chosen++].pick;
    const Lobe& lobe = lobes_[chosen];
    if (!(lobe.pick > 0.0f)) return std::nullopt;
    const float rest = size_ == 1 ? choice : std::fmin((choice - below) / lobe.pick, 0x1.fffffep-1f);
    auto s = std::visit([&](const auto& m) { return m.sample(wo, u, rest); }, lobe.model);
    if (!s) return std::nullopt;
    if (size_ == 1) {
        s->weight *= lobe.weight;
        return s;
    }
    if (lobe.delta) {
        s->weight *= lobe.weight * (1.0f / lobe.pick);
        return s;
    }
    // Several lobes can make this direction: the balance of all of them, not of the one that did.
    const LobeEval all = eval(wo, s->wi);
    if (!(all.pdf > 0.0f)) return std::nullopt;
    s->weight = all.f / all.pdf;
    s->pdf = all.pdf;
    return s;
}

Color LobeList::albedo(Vec3f wo) const noexcept {
    Color sum(0.0f);
    for (int i = 0; i < size_; ++i) {
        sum += lobes_[i].weight * std::visit([&](const auto& m) { return m.albedo(wo); }, lobes_[i].model);
    }
    return sum;
}

}  // namespace tessera
