#pragma once
// The names and groups of a scene's lights, for light path expressions and light groups.

#include <map>
#include <string>
#include <vector>

#include "renderer/core/light_event.h"

namespace tessera {

class LightTags {
public:
    /// The number of a tag; "" is no group ("default") or no name. A scene of very many names keeps
    /// the groups alone.
    int add(const std::string& group, const std::string& name);
    void tag_material(int material, const std::string& group, const std::string& name);
    /// Of what a material emits.
    int of_material(int material) const noexcept {
        const auto m = static_cast<std::size_t>(material);
        return m < materials_.size() ? materials_[m] : 0;
    }

    const std::vector<LightTag>& tags() const noexcept { return tags_; }
    const std::vector<std::string>& groups() const noexcept { return groups_; }

private:
    std::vector<LightTag> tags_{LightTag{}};
    std::vector<std::string> groups_{"default"};
    std::map<std::pair<int, std::string>, int> known_{{{0, ""}, 0}};
    std::vector<int> materials_;
};

}  // namespace tessera
