#include <fmt/format.h>

#include "renderer/io/scene_shapes.h"

namespace tessera {
namespace {

struct InstanceEntry {
    CommonEntry common;
    std::string of;
    std::string transforms;
};

struct GroupEntry {
    CommonEntry common;
    const Value* members = nullptr;
};

const KeySet<InstanceEntry>& instance_rows() {
    using I = InstanceEntry;
    static const auto keys = rows_with_common<I>(
        "instance", {
                        key("of", &I::of, "The name of a mesh, sphere, disc or group.").must(),
                        key("transforms", &I::transforms,
                            "File of many placements: rows of 3x4 little-endian 32-bit floats, "
                            "instead of the transform keys."),
                    });
    return keys;
}

const KeySet<GroupEntry>& group_rows() {
    static const auto keys = [] {
        const auto store = [](void* object, const Value& value, const Key& key,
                              const ReadContext& at) {
            if (!value.list()) return report_misfit(value, key.name, "tables in brackets", at);
            static_cast<GroupEntry*>(object)->members = &value;
        };
        const Form form{.kind = Form::Kind::tables, .tables = {&instance_keys()}};
        Key members{"members", form, "What it holds, each with the keys of an instance.", store};
        return rows_with_common<GroupEntry>("group", {members.must()});
    }();
    return keys;
}

class Placer {
public:
    Placer(SceneReader& reader, ShapeNames& names) : reader_(reader), names_(names) {}

    InstanceDesc instance(const Value& table, const ReadContext& at) {
        InstanceEntry entry;
        read_keys(table, instance_rows(), entry, at);
        InstanceDesc instance{entry.common.name, table.loc, {}, {kIdentity34}, -1};
        if (entry.of.empty()) return instance;
        const Value& of = *table.find("of");
        const NamedShape* shape = names_.find(entry.of, of.loc, at);
        if (!shape) return instance;
        if (instance.name.empty()) instance.name = shape->name;
        instance.of = shape->ref;
        instance.transforms = transforms(table, entry, *shape, at);
        instance.material = reader_.material(entry.common.material, material_loc(table), at);
        if (instance.material < 0) instance.material = material_of(*shape);
        return instance;
    }

    /// What nothing refers to stands where its own keys put it.
    InstanceDesc placed_once(const NamedShape& shape) {
        return {shape.name, shape.loc, shape.ref, {shape.place}, material_of(shape)};
    }

private:
    /// What replaces the materials of a shape wherever it stands; a wrong name was reported with
    /// the shape.
    int material_of(const NamedShape& shape) const {
        const auto found = reader_.materials.find(shape.material);
        return found == reader_.materials.end() ? -1 : found->second;
    }

    std::vector<Matrix34> transforms(const Value& table, const InstanceEntry& entry,
                                     const NamedShape& shape, const ReadContext& at) {
        if (entry.transforms.empty()) {
            return {compose(read_placement(table, entry.common.place, at), shape.place)};
        }
        const Value& written = *table.find("transforms");
        for (const Key& row : placement_keys().list.keys) {
            const Value* also = table.find(row.name);
            if (also)
                at.problems.error(also->loc,
                                  at.subject + ": give transforms or " + row.name + ", not both");
        }
        std::vector<Matrix34> rows = read_transforms(entry.transforms, written, at, reader_);
        if (shape.place != kIdentity34) {
            for (Matrix34& row : rows) row = compose(row, shape.place);
        }
        return rows;
    }

    SceneReader& reader_;
    ShapeNames& names_;
};

}  // namespace

void read_groups(const Value& document, SceneReader& reader, ShapeNames& names) {
    std::vector<GroupDesc>& all = reader.scene.groups;
    std::vector<const Value*> members;
    for (const Value& table : tables_of(document, "group", reader.problems)) {
        const ReadContext at{reader.problems, subject_of("group", table, all.size())};
        GroupEntry entry;
        read_keys(table, group_rows(), entry, at);
        reader.material(entry.common.material, material_loc(table), at);
        add_named(table, entry.common, {ShapeKind::group, static_cast<int>(all.size())}, true, at,
                  names);
        all.push_back({entry.common.name, table.loc, {}});
        members.push_back(entry.members);
    }
    // Only now are all names known: a group may hold one that stands below it.
    Placer placer(reader, names);
    for (std::size_t g = 0; g < all.size(); ++g) {
        if (!members[g]) continue;
        for (const Value& table : *members[g]->list()) {
            const std::string subject = all[g].name.empty()
                                            ? fmt::format("group[{}]", g)
                                            : fmt::format("group '{}'", all[g].name);
            all[g].members.push_back(placer.instance(
                table,
                {reader.problems, fmt::format("{}: members[{}]", subject, all[g].members.size())}));
        }
    }
}

void read_instances(const Value& document, SceneReader& reader, ShapeNames& names) {
    Placer placer(reader, names);
    std::vector<InstanceDesc> placed;
    for (const Value& table : tables_of(document, "instance", reader.problems)) {
        placed.push_back(placer.instance(
            table, {reader.problems, subject_of("instance", table, placed.size())}));
    }
    std::vector<InstanceDesc>& all = reader.scene.instances;
    for (const NamedShape& shape : names.all()) {
        if (!shape.referred_to) all.push_back(placer.placed_once(shape));
    }
    std::move(placed.begin(), placed.end(), std::back_inserter(all));
}

const KeyList& group_keys() { return group_rows().list; }
const KeyList& instance_keys() { return instance_rows().list; }

}  // namespace tessera
