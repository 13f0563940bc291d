#include "renderer/film/light_paths.h"

#include <algorithm>
#include <map>

#include "renderer/film/blame.h"

namespace tessera {
namespace {

constexpr std::size_t kMostStates = 4096;
// Steps of the construction: seconds, and some hundred MB.
constexpr std::size_t kMostWork = 40'000'000;

[[noreturn]] void too_many(const SourceLoc& loc) {
    throw Error(blame(loc), loc,
                "the light path expressions are too many or too intricate together (the automaton "
                "that follows them all would be too large)");
}

// The subset construction: Rabin & Scott, "Finite Automata and Their Decision Problems", IBM
// Journal 3(2), 1959. A subset holds nodes of all expressions, numbered one after the other, and
// of these only those that matter: where events are taken, and the ends.
class Subsets {
public:
    using Set = std::vector<std::uint32_t>;

    explicit Subsets(const SourceLoc& loc) : loc_(loc) {}

    void add(const PathAutomaton& automaton) {
        const auto first = static_cast<std::uint32_t>(nodes_.size());
        for (PathAutomaton::Node node : automaton.nodes) {
            for (std::uint32_t& n : node.next) n += first;
            nodes_.push_back(std::move(node));
        }
        starts_.push_back(first);
        ends_.push_back(first + automaton.end);
        marks_.resize(nodes_.size(), 0);
        work(10 * automaton.nodes.size());
    }
    Set begin() { return closed(starts_); }
    Set moved(const Set& from, int event) {
        Set to;
        for (const std::uint32_t n : from) {
            const PathAutomaton::Node& node = nodes_[n];
            if (!node.events.empty() && node.events[static_cast<std::size_t>(event)])
                to.push_back(node.next[0]);
        }
        work(from.size());
        return closed(std::move(to));
    }
    LightPaths::State number(Set set) {
        const auto [it, added] =
            known_.try_emplace(set, static_cast<LightPaths::State>(sets_.size()));
        if (added) sets_.push_back(std::move(set));
        if (sets_.size() > kMostStates) too_many(loc_);
        return it->second;
    }
    bool ends(const Set& set, std::uint32_t expression) const {
        return std::binary_search(set.begin(), set.end(), ends_[expression]);
    }
    void work(std::size_t steps) {
        if ((work_ += steps) > kMostWork) too_many(loc_);
    }
    std::size_t size() const { return sets_.size(); }
    const Set& operator[](std::size_t state) const { return sets_[state]; }

private:
    // What is reached for nothing; sorted.
    Set closed(Set open) {
        Set set;
        ++mark_;
        while (!open.empty()) {
            const std::uint32_t n = open.back();
            open.pop_back();
            if (marks_[n] == mark_) continue;
            marks_[n] = mark_;
            work(4);
            const PathAutomaton::Node& node = nodes_[n];
            const bool end = std::binary_search(ends_.begin(), ends_.end(), n);
            if (end || !node.events.empty()) set.push_back(n);
            if (node.events.empty()) open.insert(open.end(), node.next.begin(), node.next.end());
        }
        std::sort(set.begin(), set.end());
        return set;
    }

    const SourceLoc& loc_;
    std::vector<PathAutomaton::Node> nodes_;
    Set starts_, ends_;                 // by expression
    std::vector<std::uint32_t> marks_;  // by node: the last closure that it was in
    std::uint32_t mark_ = 0;
    std::map<Set, LightPaths::State> known_;
    std::vector<Set> sets_;
    std::size_t work_ = 0;
};

}  // namespace

LightPaths::LightPaths(const Passes& passes, std::vector<LightTag> tags, const SourceLoc& loc) {
    const PathAlphabet alphabet(std::move(tags));
    tags_ = alphabet.tags().size();
    Subsets subsets(loc);
    std::vector<int> groups;
    std::map<std::string, std::uint32_t> parsed;  // passes of groups share their expression
    std::vector<std::uint32_t> of_pass;
    for (const Pass& p : passes) {
        if (p.source != PassSource::light_paths) continue;
        const auto [it, added] =
            parsed.try_emplace(p.expression, static_cast<std::uint32_t>(parsed.size()));
        if (added) subsets.add(parse_light_paths(p.expression, alphabet, loc));
        of_pass.push_back(it->second);
        groups.push_back(p.group);
    }
    passes_ = static_cast<int>(of_pass.size());

    subsets.number({});  // kDead
    start_ = subsets.number(subsets.moved(subsets.begin(), PathAlphabet::kCamera));
    for (std::size_t s = 0; s < subsets.size(); ++s) {
        const Subsets::Set from = subsets[s];
        for (int e = 0; e < kLobeEvents; ++e)
            after_.push_back(subsets.number(subsets.moved(from, PathAlphabet::kFirstLobe + e)));
        for (int type = 0; type < kLightTypes; ++type) {
            for (std::size_t tag = 0; tag < tags_; ++tag) {
                const Subsets::Set end = subsets.moved(
                    from, alphabet.light(static_cast<LightType>(type), static_cast<int>(tag)));
                first_.push_back(static_cast<std::uint32_t>(taken_.size()));
                subsets.work(of_pass.size());
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

void LightPaths::split_by_tag() {
    for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
        for (std::uint32_t k = first_[i]; k < first_[i + 1]; ++k)
            taken_[k] = static_cast<std::uint16_t>(taken_[k] * tags_ + i % tags_);
    }
    passes_ *= static_cast<int>(tags_);
}

bool LightPaths::is_taken(int pass) const {
    return std::find(taken_.begin(), taken_.end(), pass) != taken_.end();
}

}  // namespace tessera
