#include <algorithm>
#include <string>
#include <vector>

#include "renderer/io/scene_shapes.h"

namespace tessera {
namespace {

constexpr int kMaxNesting = 64;
constexpr double kMaxPlacements = 1 << 26;

/// Counts what each group places once all groups inside it are taken apart.
class GroupCounter {
public:
    GroupCounter(const SceneDesc& scene, Problems& problems)
        : scene_(scene),
          problems_(problems),
          counts_(scene.groups.size(), kUnknown),
          depths_(scene.groups.size(), 0) {}

    bool count_groups() {
        for (std::size_t g = 0; g < counts_.size(); ++g) count(g);
        return sound_;
    }

    double placements(const std::vector<InstanceDesc>& instances) {
        double sum = 0;
        for (const InstanceDesc& instance : instances) {
            const bool group = instance.of.kind == ShapeKind::group && instance.of.index >= 0;
            const double each = group ? count(static_cast<std::size_t>(instance.of.index)) : 1;
            sum += each * static_cast<double>(instance.transforms.size());
        }
        return sum;
    }

private:
    static constexpr double kUnknown = -1;
    static constexpr double kOpen = -2;

    double count(std::size_t g) {
        if (!sound_) return 0;  // one report is enough
        if (counts_[g] >= 0) return counts_[g];
        if (counts_[g] == kOpen) return fail(g, "contains itself (" + chain(g) + ")");
        if (open_.size() >= kMaxNesting) return fail(g, "is nested deeper than 64 groups");
        counts_[g] = kOpen;
        open_.push_back(g);
        const double sum = placements(scene_.groups[g].members);
        open_.pop_back();
        for (const InstanceDesc& member : scene_.groups[g].members) {
            if (member.of.kind != ShapeKind::group || member.of.index < 0) continue;
            depths_[g] =
                std::max(depths_[g], depths_[static_cast<std::size_t>(member.of.index)] + 1);
        }
        counts_[g] = sum;
        return depths_[g] < kMaxNesting ? sum : fail(g, "is nested deeper than 64 groups");
    }

    double fail(std::size_t g, const std::string& why) {
        const GroupDesc& group = scene_.groups[g];
        problems_.error(group.loc, "group '" + group.name + "' " + why);
        sound_ = false;
        return 0;
    }

    std::string chain(std::size_t g) const {
        std::string text;
        bool inside = false;
        for (const std::size_t open : open_) {
            inside = inside || open == g;
            if (inside) text += scene_.groups[open].name + " > ";
        }
        return text + scene_.groups[g].name;
    }

    const SceneDesc& scene_;
    Problems& problems_;
    std::vector<double> counts_;
    std::vector<int> depths_;
    std::vector<std::size_t> open_;
    bool sound_ = true;
};

}  // namespace

void check_groups(const SceneDesc& scene, Problems& problems) {
    GroupCounter counter(scene, problems);
    if (!counter.count_groups()) return;
    if (counter.placements(scene.instances) > kMaxPlacements) {
        problems.error({}, scene.path +
                               ": the scene places more than 67 108 864 shapes once its groups are "
                               "taken apart");
    }
}

}  // namespace tessera
