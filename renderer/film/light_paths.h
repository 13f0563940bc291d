#pragma once
// The light path expressions of all passes as one deterministic automaton: a path carries its
// state, and at a light the state says which passes take it.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/film/light_path_syntax.h"
#include "renderer/film/pass.h"

namespace tessera {

class LightPaths {
public:
    using State = std::uint32_t;
    static constexpr State kDead = 0;  // no pass can take such a path any more

    LightPaths() = default;
    /// passes: those of light_paths are numbered in their order. Throws Error as choose_passes.
    LightPaths(const Passes& passes, std::vector<LightTag> tags, const SourceLoc& loc);

    /// Every pass apart by the light's tag: number pass * tags() + tag.
    void split_by_tag();

    int passes() const noexcept { return passes_; }
    int tags() const noexcept { return static_cast<int>(tags_); }
    int states() const noexcept { return static_cast<int>(after_.size()) / kLobeEvents; }
    /// After the camera.
    State start() const noexcept { return start_; }
    State after(State s, LobeEvent e) const noexcept {
        return after_[std::size_t(s) * kLobeEvents + static_cast<std::size_t>(e)];
    }
    /// Numbers of the passes that take light of a type and tag at the end of a path in state s.
    std::span<const std::uint16_t> taking(State s, LightType type, int tag) const noexcept {
        const std::size_t i =
            (std::size_t(s) * kLightTypes + static_cast<std::size_t>(type)) * tags_ +
            static_cast<std::size_t>(tag);
        return {taken_.data() + first_[i], taken_.data() + first_[i + 1]};
    }

    /// Whether any path of light at all is the pass's: false for an expression that has no light in
    /// the end, say.
    bool is_taken(int pass) const;

private:
    int passes_ = 0;
    std::size_t tags_ = 1;
    State start_ = kDead;
    std::vector<State> after_;          // by state and event
    std::vector<std::uint32_t> first_;  // by state, light type and tag: into taken_
    std::vector<std::uint16_t> taken_;
};

}  // namespace tessera
