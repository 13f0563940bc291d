#include "renderer/scene/light_tags.h"

#include <algorithm>

namespace tessera {

int LightTags::add(const std::string& group, const std::string& name) {
    constexpr std::size_t kMostTags = 256;
    int g = 0;
    if (!group.empty()) {
        const auto it = std::find(groups_.begin(), groups_.end(), group);
        g = static_cast<int>(it - groups_.begin());
        if (it == groups_.end()) groups_.push_back(group);
    }
    const auto known = known_.find({g, name});
    if (known != known_.end()) return known->second;
    if (tags_.size() >= kMostTags && !name.empty()) return add(group, "");
    const int tag = static_cast<int>(tags_.size());
    tags_.push_back({g, groups_[static_cast<std::size_t>(g)], name});
    known_[{g, name}] = tag;
    return tag;
}

void LightTags::tag_material(int material, const std::string& group, const std::string& name) {
    const auto m = static_cast<std::size_t>(material);
    if (materials_.size() <= m) materials_.resize(m + 1, 0);
    materials_[m] = add(group, name);
}

}  // namespace tessera
