#pragma once
// Light path expressions as text: to a nondeterministic automaton. The grammar is Open Shading
// Language's (Gritz et al., "Open Shading Language", SIGGRAPH 2010; OSL's wiki page on light path
// expressions).

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/core/light_event.h"

namespace tessera {

/// All events there can be, numbered: the camera, the lobes', and the light types times the tags.
class PathAlphabet {
public:
    explicit PathAlphabet(std::vector<LightTag> tags) : tags_(std::move(tags)) {}
    static constexpr int kCamera = 0, kFirstLobe = 1, kFirstLight = 1 + kLobeEvents;
    int size() const { return kFirstLight + kLightTypes * static_cast<int>(tags_.size()); }
    int light(LightType type, int tag) const {
        return kFirstLight + static_cast<int>(type) * static_cast<int>(tags_.size()) + tag;
    }
    /// Whether an event is of a type and scattering ('.': any) and, if there are labels, has one.
    bool matches(int event, char type, char scattering,
                 const std::vector<std::string>& labels) const;
    /// Whether any event has the label.
    bool knows(const std::string& label) const;
    /// The labels there are, "'a', 'b'", for messages.
    std::string labels() const;
    const std::vector<LightTag>& tags() const { return tags_; }

private:
    std::vector<LightTag> tags_;
};

/// Thompson, "Regular Expression Search Algorithm", CACM 11(6), 1968. Node 0 is the start.
struct PathAutomaton {
    struct Node {
        std::vector<bool> events;         // that lead on to `next`; empty: nothing is consumed
        std::vector<std::uint32_t> next;  // one after events, any number after nothing
    };
    std::vector<Node> nodes;
    std::uint32_t end = 0;
};

/// Throws Error, scene if it stands in one, else usage: where in the expression, and what was
/// expected.
PathAutomaton parse_light_paths(const std::string& expression, const PathAlphabet& alphabet,
                                const SourceLoc& loc);

}  // namespace tessera
