#pragma once
// The shapes of a scene by name, and what places them. Private to the scene reader.

#include <map>
#include <string>
#include <vector>

#include "renderer/io/scene_placement.h"

namespace tessera {

/// A mesh, sphere, disc or group under the name that instances call it by.
struct NamedShape {
    std::string name;
    SourceLoc loc;
    ShapeRef ref;
    std::string material;  // replaces every material of the shape; "" = none
    SourceLoc material_loc;
    Matrix34 place = kIdentity34;  // the shape's own transform
    bool referred_to = false;      // an instance or a group has it
};

/// All shapes of a scene. One namespace for every kind; a mesh without a name is called after its
/// file.
class ShapeNames {
public:
    void add(NamedShape shape, bool named, Problems& problems);
    /// The shape of a name; nullptr after reporting that there is none, or more than one.
    NamedShape* find(const std::string& name, const SourceLoc& loc, const ReadContext& at);
    std::vector<NamedShape>& all() { return shapes_; }

private:
    std::vector<NamedShape> shapes_;
    struct Holder {
        std::size_t index = 0;
        bool named = false;      // a name given by hand wins over one taken from a file
        bool ambiguous = false;  // two files lend the same name
    };
    std::map<std::string, Holder, std::less<>> by_name_;
};

/// The keys every shape has.
struct CommonEntry {
    std::string name;
    std::string material;
    PlacementEntry place;
};

const KeySet<CommonEntry>& common_rows();

/// Rows of one kind of shape: its own, then the common ones.
template <class Entry>
KeySet<Entry> rows_with_common(const std::string& title, std::vector<Key> own) {
    KeySet<Entry> rows{{title, std::move(own)}};
    add_part(rows, common_rows(), &Entry::common);
    return rows;
}

/// The entries of [[key]]; empty after reporting a key that is no list.
const List& tables_of(const Value& document, const char* key, Problems& problems);
/// Where a table names its material.
SourceLoc material_loc(const Value& table);
/// Adds a shape under its name, with its transform. named: by hand, not after its file.
void add_named(const Value& table, const CommonEntry& common, const ShapeRef& ref, bool named,
               const ReadContext& at, ShapeNames& names);

void read_groups(const Value& document, SceneReader& reader, ShapeNames& names);
/// Appends to scene.instances what nothing refers to, placed once, then the [[instance]]s.
void read_instances(const Value& document, SceneReader& reader, ShapeNames& names);
/// Reports groups that contain themselves or nest deeper than 64, and scenes of more than 2^26
/// placements.
void check_groups(const SceneDesc& scene, Problems& problems);

}  // namespace tessera
