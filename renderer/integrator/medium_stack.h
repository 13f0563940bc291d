#pragma once
// What a path is inside of. Schmidt & Budge, "Simple Nested Dielectrics in Ray Traced Images",
// Journal of Graphics Tools 7(2), 2002; of overlapping bodies the one with the higher priority is
// there.

#include <cstdint>

#include "materials/medium.h"

namespace tessera {

class MediumStack {
public:
    struct Body {
        std::int32_t material = -1;
        int priority = 0;
        float ior = 1;
        Medium medium;
    };
    static constexpr int kDepth = 8;

    void clear() noexcept { size_ = 0; }
    /// The body that is here, with `without` (the latest of that material) taken away; null: air.
    const Body* here(std::int32_t without = -1) const noexcept {
        const int left_out = find(without);
        const Body* best = nullptr;
        for (int i = 0; i < size_; ++i)
            if (i != left_out && (!best || bodies_[i].priority >= best->priority))
                best = &bodies_[i];
        return best;
    }
    bool holds(std::int32_t material) const noexcept { return find(material) >= 0; }

    /// Beyond kDepth bodies nothing is kept: what is nested deeper counts as air.
    void enter(const Body& body) noexcept {
        if (size_ < kDepth) bodies_[size_++] = body;
    }
    /// A body that was never entered (the camera was inside, or the mesh is open) is ignored.
    void leave(std::int32_t material) noexcept {
        const int at = find(material);
        if (at < 0) return;
        for (int i = at; i + 1 < size_; ++i) bodies_[i] = bodies_[i + 1];
        --size_;
    }

private:
    int find(std::int32_t material) const noexcept {
        for (int i = size_ - 1; material >= 0 && i >= 0; --i)
            if (bodies_[i].material == material) return i;
        return -1;
    }

    Body bodies_[kDepth];
    int size_ = 0;
};

}  // namespace tessera
