#include "renderer/core/nearest_name.h"
#include "renderer/io/scene_shapes.h"

namespace tessera {

const KeySet<CommonEntry>& common_rows() {
    static const KeySet<CommonEntry> keys = [] {
        KeySet<CommonEntry> rows{
            {"shape",
             {
                 key("name", &CommonEntry::name, "What instances and groups call it."),
                 key("material", &CommonEntry::material,
                     "A [material.NAME]; replaces every material it has."),
             }}};
        add_part(rows, placement_keys(), &CommonEntry::place);
        return rows;
    }();
    return keys;
}

const List& tables_of(const Value& document, const char* key, Problems& problems) {
    static const List none;
    const Value* value = document.find(key);
    if (!value) return none;
    if (value->list()) return *value->list();
    const std::string wanted = "written as [[" + std::string(key) + "]]";
    report_misfit(*value, key, wanted, {problems, ""});
    return none;
}

void add_named(const Value& table, const CommonEntry& common, const ShapeRef& ref, bool named,
               const ReadContext& at, ShapeNames& names) {
    const Matrix34 place = read_placement(table, common.place, at);
    names.add({common.name, table.loc, ref, common.material, material_loc(table), place},
              named && !common.name.empty(), at.problems);
}

SourceLoc material_loc(const Value& table) {
    const Value* written = table.find("material");
    return written ? written->loc : table.loc;
}

void ShapeNames::add(NamedShape shape, bool named, Problems& problems) {
    const std::size_t index = shapes_.size();
    if (!shape.name.empty()) {
        const auto [entry, is_new] = by_name_.try_emplace(shape.name, Holder{index, named, false});
        Holder& holder = entry->second;
        if (!is_new && named && holder.named) {
            const std::string before = to_string(shapes_[holder.index].loc);
            problems.error(shape.loc, "the name '" + shape.name + "' is taken (at " + before + ")");
        } else if (!is_new && named) {
            holder = {index, true, false};
        } else if (!is_new && !holder.named) {
            holder.ambiguous = true;
        }
    }
    shapes_.push_back(std::move(shape));
}

NamedShape* ShapeNames::find(const std::string& name, const SourceLoc& loc, const ReadContext& at) {
    const auto found = by_name_.find(name);
    if (found == by_name_.end()) {
        std::vector<std::string> names;
        for (const auto& [known, holder] : by_name_) names.push_back(known);
        at.problems.error(
            loc, at.subject + ": there is no shape '" + name + "'" + did_you_mean(name, names));
        return nullptr;
    }
    if (found->second.ambiguous) {
        at.problems.error(
            loc, at.subject + ": more than one shape is called '" + name + "', give each a name");
        return nullptr;
    }
    NamedShape& shape = shapes_[found->second.index];
    shape.referred_to = true;
    return &shape;
}

}  // namespace tessera
