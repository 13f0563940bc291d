#include "renderer/film/light_paths.h"

#include <algorithm>
#include <map>

namespace tessera {
namespace {

constexpr std::size_t kMostStates = 4096;

// The subset construction: Rabin & Scott, "Finite Automata and Their Decision Problems", IBM
// Journal 3(2), 1959. A subset holds (expression, node) pairs.
struct Subsets {
    using Place = std::pair<std::uint32_t, std::uint32_t>;
    using Set = std::vector<Place>;

    const std::vector<PathAutomaton>& automata;
    std::map<Set, LightPaths::State> known;
    std::vector<Set> sets;

    // With all that is reached for nothing; sorted.
    Set closed(Set set) const {
        std::sort(set.begin(), set.end());
        set.erase(std::unique(set.begin(), set.end()), set.end());
        std::vector<Place> open = set;
        std::map<Place, bool> seen;
        for (const Place& p : set) seen[p] = true;
        while (!open.empty()) {
            const Place p = open.back();
            open.pop_back();
            const PathAutomaton::Node& node = automata[p.first].nodes[p.second];
            if (!node.events.empty()) continue;
            for (const std::uint32_t n : node.next) {
                if (seen[{p.first, n}]) continue;
                seen[{p.first, n}] = true;
                set.push_back({p.first, n});
                open.push_back({p.first, n});
            }
        }
        std::sort(set.begin(), set.end());
        return set;
    }
    Set moved(const Set& from, int event) const {
        Set to;
        for (const Place& p : from) {
            const PathAutomaton::Node& node = automata[p.first].nodes[p.second];
            if (!node.events.empty() && node.events[static_cast<std::size_t>(event)])
                to.push_back({p.first, node.next[0]});
        }
        return closed(std::move(to));
    }
    LightPaths::State number(Set set) {
        const auto [it, added] =
            known.try_emplace(set, static_cast<LightPaths::State>(sets.size()));
        if (added) sets.push_back(std::move(set));
        return it->second;
    }
    bool ends(const Set& set, std::uint32_t expression) const {
        return std::binary_search(set.begin(), set.end(),
                                  Place{expression, automata[expression].end});
    }
};

}  // namespace

LightPaths::LightPaths(const Passes& passes, std::vector<LightTag> tags, const SourceLoc& loc) {
    const PathAlphabet alphabet(std::move(tags));
    tags_ = alphabet.tags().size();
    std::vector<PathAutomaton> automata;
    std::vector<int> groups;
    std::map<std::string, std::uint32_t> parsed;  // passes of groups share their expression
    std::vector<std::uint32_t> of_pass;
    for (const Pass& p : passes) {
        if (p.source != PassSource::light_paths) continue;
        const auto [it, added] =
            parsed.try_emplace(p.expression, static_cast<std::uint32_t>(automata.size()));
        if (added) automata.push_back(parse_light_paths(p.expression, alphabet, loc));
        of_pass.push_back(it->second);
        groups.push_back(p.group);
    }
    passes_ = static_cast<int>(of_pass.size());

    Subsets subsets{automata, {}, {}};
    subsets.number({});  // kDead
    Subsets::Set begin;
    for (std::uint32_t e = 0; e < automata.size(); ++e) begin.push_back({e, 0});
    start_ = subsets.number(subsets.moved(subsets.closed(std::move(begin)), PathAlphabet::kCamera));
    for (std::size_t s = 0; s < subsets.sets.size(); ++s) {
        if (subsets.sets.size() > kMostStates)
            throw Error(ExitCode::usage, loc, "the light path expressions are too many together");
        const Subsets::Set from = subsets.sets[s];
        for (int e = 0; e < kLobeEvents; ++e)
            after_.push_back(subsets.number(subsets.moved(from, PathAlphabet::kFirstLobe + e)));
        for (int type = 0; type < kLightTypes; ++type) {
            for (std::size_t tag = 0; tag < tags_; ++tag) {
                const Subsets::Set end = subsets.moved(
                    from, alphabet.light(static_cast<LightType>(type), static_cast<int>(tag)));
                first_.push_back(static_cast<std::uint32_t>(taken_.size()));
                for (std::size_t p = 0; p < of_pass.size(); ++p) {
                    const bool in_group = groups[p] < 0 || alphabet.tags()[tag].group == groups[p];
                    if (in_group && subsets.ends(end, of_pass[p]))
                        taken_.push_back(static_cast<std::uint16_t>(p));
                }
            }
        }
    }
    first_.push_back(static_cast<std::uint32_t>(taken_.size()));
}

}  // namespace tessera
