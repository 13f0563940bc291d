#include <algorithm>
#include <array>

#include "renderer/api/openpbr_inputs.h"
#include "renderer/core/nearest_name.h"
#include "renderer/io/light_group_key.h"
#include "renderer/io/presets.h"
#include "renderer/io/scene_environment.h"
#include "renderer/io/scene_layers.h"
#include "renderer/io/scene_nodes.h"
#include "renderer/io/scene_parse.h"
#include "renderer/io/scene_textures.h"

namespace tessera {
namespace {

constexpr int kMaxInheritance = 64;

/// What a [material.NAME] is read into: custom rows need the reader beside the material.
struct MaterialTarget {
    MaterialDesc& material;
    SceneReader& reader;
    NodeReader& nodes;
};

template <class Input>
void read_graph(Input MaterialDesc::*member, const Value& value, const Key& key,
                const ReadContext& at, const MaterialTarget& target) {
    const auto node = target.nodes.read(value, type_of(member), key.name, at);
    if (!node) return;
    set_input(target.material.*member, *node);
}

bool same_place(const SourceLoc& a, const SourceLoc& b) {
    return a.file == b.file && a.line == b.line && a.column == b.column;
}

bool is_image(const Value& value) { return value.table() != nullptr; }

Form input_form(int count, const Limits& limits, const KeySet<TextureEntry>& image) {
    return {.kind = Form::Kind::input,
            .count = count,
            .or_one = true,
            .limits = limits,
            .tables = {&image.list}};
}

/// key read as plain numbers (of an input that is no image).
std::optional<Plain> plain_input(const Value& value, const Key& key, const ReadContext& at) {
    const bool writable = value.list() || std::holds_alternative<double>(value.data) ||
                          std::holds_alternative<std::int64_t>(value.data);
    const auto count = static_cast<std::size_t>(key.form.count);
    if (!writable || (value.list() && (count == 1 || value.list()->size() != count))) {
        report_misfit(value, key.name, describe(key.form), at);
        return std::nullopt;
    }
    Key plain{key.name, key.form, "", nullptr};
    plain.form.kind = key.form.count == 1 ? Form::Kind::number : Form::Kind::numbers;
    return plain_value(value, plain, at);
}

TextureEntry read_image(const Value& value, const KeySet<TextureEntry>& keys, const Key& key,
                        const ReadContext& at) {
    TextureEntry entry;
    read_keys(value, keys, entry, {at.problems, at.subject + ": " + key.name});
    return entry;
}

Key input_row(ColorInput MaterialDesc::*member, const OpenPbrInput& info) {
    const Limits limits{.low = info.low, .high = info.high, .clamp = true};
    const auto store = [member](void* object, const Value& value, const Key& key,
                                const ReadContext& at) {
        const auto& target = *static_cast<MaterialTarget*>(object);
        ColorInput& input = target.material.*member;
        if (NodeReader::is_graph(value)) {
            read_graph(member, value, key, at, target);
        } else if (is_image(value)) {
            const TextureEntry entry = read_image(value, color_texture_keys(), key, at);
            input = {entry.tint, add_texture(value, entry, at, target.reader)};
        } else if (const auto plain = plain_input(value, key, at)) {
            input = {};
            params::assign(*plain, input.value);
        }
    };
    const Float3 initial = (MaterialDesc{}.*member).value;
    return {info.name, input_form(3, limits, color_texture_keys()), info.help, store,
            params::json(std::vector<double>(initial.begin(), initial.end()))};
}

Key input_row(FloatInput MaterialDesc::*member, const OpenPbrInput& info) {
    const Limits limits{.low = info.low, .high = info.high};
    const auto store = [member](void* object, const Value& value, const Key& key,
                                const ReadContext& at) {
        const auto& target = *static_cast<MaterialTarget*>(object);
        FloatInput& input = target.material.*member;
        if (NodeReader::is_graph(value)) {
            read_graph(member, value, key, at, target);
        } else if (is_image(value)) {
            const TextureEntry entry = read_image(value, scalar_texture_keys(), key, at);
            const int texture = add_texture(value, entry, at, target.reader);
            input = {entry.factor, texture, entry.channel, entry.invert};
        } else if (const auto plain = plain_input(value, key, at)) {
            input = {};
            params::assign(*plain, input.value);
        }
    };
    return {info.name, input_form(1, limits, scalar_texture_keys()), info.help, store,
            params::json(double((MaterialDesc{}.*member).value))};
}

Key normal_input(const NormalKey& normal) {
    const auto store = [normal](void* object, const Value& value, const Key& key,
                                const ReadContext& at) {
        const auto& target = *static_cast<MaterialTarget*>(object);
        NormalInput& input = target.material.*normal.member;
        if (NodeReader::is_graph(value)) {
            if (const auto node = target.nodes.read_normal(value, key.name, at))
                set_input(input, *node);
        } else if (is_image(value) && normal.takes_maps) {
            const TextureEntry entry = read_image(value, normal_texture_keys(), key, at);
            input = {add_texture(value, entry, at, target.reader), entry.scale_normal,
                     entry.convention == NormalConvention::directx};
        } else {
            report_misfit(value, key.name, describe(key.form), at);
        }
    };
    Form form{.kind = Form::Kind::image, .tables = {&normal_texture_keys().list}};
    if (!normal.takes_maps) form.tables.clear();
    return {normal.name, form, normal.help, store};
}

/// A row of a MaterialDesc, for a MaterialTarget.
Key of_target(Key row) {
    row.store = [inner = row.store](void* object, const Value& value, const Key& k,
                                    const ReadContext& at) {
        inner(&static_cast<MaterialTarget*>(object)->material, value, k, at);
    };
    return row;
}

/// A row whose member is plain.
template <class M>
Key plain_row(const std::string& name, M MaterialDesc::*member, const std::string& help,
              const Limits& limits = kAnyNumber) {
    return of_target(key(name, member, help, limits));
}

template <class E>
Key choice_row(const std::string& name, E MaterialDesc::*member, std::vector<std::string> words,
               const std::string& help) {
    return of_target(choice(name, member, std::move(words), help));
}

/// inherits is read before all else; here it only has its place in the list.
Key inherits_row() {
    const auto store = [](void*, const Value&, const Key&, const ReadContext&) {};
    const Form form{.kind = Form::Kind::text};
    return {"inherits", form,
            "Starts from this material; its own name: from the OBJ library's of that name; "
            "\"preset:gold\": from one that comes with Tessera.",
            store};
}

/// Nodes by name are read where something refers to them.
Key nodes_row() {
    const auto store = [](void*, const Value& value, const Key& key, const ReadContext& at) {
        if (!value.table())
            report_misfit(value, key.name, "tables named [material.NAME.node.X]", at);
    };
    const Form form{.kind = Form::Kind::free_tables};
    return {"node", form, "Nodes of the material's graph, by name (docs/nodes.md).", store};
}

/// Layers are read when all else is there, to lie on it.
Key layers_row() {
    const auto store = [](void*, const Value&, const Key&, const ReadContext&) {};
    const Form form{.kind = Form::Kind::free_tables};
    return {"layer", form, "Layers on the material, from the lowest up.", store};
}

Key reflection_map_row() {
    const auto store = [](void* object, const Value& value, const Key& key, const ReadContext& at) {
        auto& target = *static_cast<MaterialTarget*>(object);
        if (!value.table()) return report_misfit(value, key.name, describe(key.form), at);
        target.material.reflection_map = read_reflection_map(value, target.reader, at);
    };
    const Form form{.kind = Form::Kind::table, .tables = {&reflection_map_keys().list}};
    return {"reflection_map", form,
            "A map that specular, coat and metal reflect in place of the scene.", store};
}

std::vector<Key> supported_rows() {
    using M = MaterialDesc;
    std::vector<Key> rows{inherits_row(), nodes_row(), layers_row()};
    visit_inputs(
        [&](auto member, const OpenPbrInput& info) { rows.push_back(input_row(member, info)); });
    rows.push_back(plain_row("displacement_scale", &M::displacement_scale,
                             "Scene units that a displacement of 1 comes to."));
    rows.push_back(plain_row("displacement_offset", &M::displacement_offset,
                             "Scene units added to the height: -scale / 2 for a map whose middle "
                             "grey means no displacement."));
    rows.push_back(choice_row("displacement_space", &M::displacement_space, {"tangent", "object"},
                              "Of vector_displacement: along u, across it and along the normal; or "
                              "the object's axes."));
    rows.push_back(
        plain_row("geometry_thin_walled", &M::geometry_thin_walled, "A sheet without an inside."));
    for (const NormalKey& normal : kNormalKeys) rows.push_back(normal_input(normal));
    rows.push_back(plain_row("dielectric_priority", &M::dielectric_priority,
                             "Where solids of glass overlap, the higher number is there.",
                             {.low = -1000, .high = 1000}));
    rows.push_back(plain_row("use_vertex_color", &M::use_vertex_color,
                             "base_color is multiplied by the mesh's colours."));
    rows.push_back(of_target(light_group_key(&MaterialDesc::light_group)));
    rows.push_back(reflection_map_row());
    return rows;
}

const KeySet<MaterialTarget>& material_rows() {
    static const KeySet<MaterialTarget> keys{{"material", supported_rows()}};
    return keys;
}

/// Reads the [material.*] tables, each after the one it inherits from.
class MaterialReader {
public:
    MaterialReader(const Value& tables, SceneReader& reader) : tables_(tables), reader_(reader) {
        for (std::size_t i = 0; i < reader.scene.materials.size(); ++i) {
            const std::string& name = reader.scene.materials[i].name;
            library_[name].push_back(static_cast<int>(i));
            reader.materials.emplace(name, static_cast<int>(i));
        }
    }

    void read_all() {
        for (const auto& [name, table] : *tables_.table()) read(name, table, 0);
    }

private:
    void read(const std::string& name, const Value& table, int depth) {
        if (!started_.insert(name).second) return;
        const ReadContext at{reader_.problems, "material '" + name + "'", "input"};
        MaterialDesc material = inherited(name, table, depth, at);
        material.name = name;
        material.loc = table.loc;
        fill(material, table, nodes_of(name, table), at);
        put(name, std::move(material), table.find("inherits") != nullptr);
        done_.insert(name);
    }

    /// The nodes that can be named: the material's own, and those of what it inherits from.
    const Value* nodes_of(const std::string& name, const Value& table) {
        Value all{Table{}, table.loc};
        const Value* inherits = table.find("inherits");
        if (inherits && inherits->text()) {
            const auto parent = nodes_.find(*inherits->text());
            if (parent != nodes_.end()) all = parent->second;
        }
        if (const Value* own = table.find("node"); own && own->table())
            for (const auto& [key, value] : *own->table())
                std::get<Table>(all.data).insert_or_assign(key, value);
        return &(nodes_[name] = std::move(all));
    }

    void fill(MaterialDesc& material, const Value& table, const Value* named,
              const ReadContext& at) {
        NodeReader nodes(material, reader_, named);
        MaterialTarget target{material, reader_, nodes};
        read_keys(table, material_rows(), target, at);
        for (const char* key :
             {"displacement_scale", "displacement", "vector_displacement", "displacement_offset"})
            if (const Value* written = table.find(key)) {
                material.displacement_loc = written->loc;
                break;
            }
        if (const Value* layers = table.find("layer"))
            read_material_layers(*layers, material, nodes, at);
        nodes.read_unused(table.find("node"), at);
    }

    MaterialDesc preset(const std::string& name, const Value& written, const ReadContext& at) {
        std::vector<std::string> names;
        for (const Preset& p : presets()) {
            names.emplace_back(p.name);
            if (p.name != name) continue;
            const Value document = parse_toml(p.text, "preset:" + name);
            const Value* table = document.find("material")->find(name);
            MaterialDesc material;
            fill(material, *table, table->find("node"),
                 {at.problems, "preset '" + name + "'", "input"});
            return material;
        }
        at.problems.error(written.loc, at.subject + ": there is no preset '" + name + "'" +
                                           did_you_mean(name, names));
        return {};
    }

    MaterialDesc inherited(const std::string& name, const Value& table, int depth,
                           const ReadContext& at) {
        const Value* inherits = table.find("inherits");
        if (!inherits) return {};
        if (!inherits->text()) {
            report_misfit(*inherits, "inherits", "a text in quotes", at);
            return {};
        }
        const std::string& parent = *inherits->text();
        constexpr std::string_view kPreset = "preset:";
        if (parent.starts_with(kPreset))
            return preset(parent.substr(kPreset.size()), *inherits, at);
        const Value* parent_table = parent == name ? nullptr : tables_.find(parent);
        if (parent_table) {
            if (depth < kMaxInheritance) read(parent, *parent_table, depth + 1);
            if (!done_.contains(parent)) {
                at.problems.error(inherits->loc,
                                  at.subject + ": inherits in a circle or deeper than 64");
                return {};
            }
        } else if (!library_.contains(parent)) {
            std::vector<std::string> names;
            for (const auto& [known, index] : library_) names.push_back(known);
            for (const auto& [known, other] : *tables_.table()) {
                if (known != name) names.push_back(known);
            }
            // --set of a name that is not there: nobody wrote "inherits".
            const bool implied = parent == name && same_place(inherits->loc, table.loc);
            at.problems.error(inherits->loc, (implied ? "there is no material '" + parent + "'"
                                                      : at.subject + ": there is no material '" +
                                                            parent + "' to inherit from") +
                                                 did_you_mean(parent, names));
            return {};
        }
        return reader_.scene.materials[static_cast<std::size_t>(reader_.materials.at(parent))];
    }

    void put(const std::string& name, MaterialDesc material, bool inherits) {
        std::vector<MaterialDesc>& all = reader_.scene.materials;
        const auto old = library_.find(name);
        if (old == library_.end()) {
            reader_.materials[name] = static_cast<int>(all.size());
            all.push_back(std::move(material));
            return;
        }
        const bool from_library = std::any_of(old->second.begin(), old->second.end(), [&](int i) {
            return all[static_cast<std::size_t>(i)].loc.file != nullptr;
        });
        const std::string did = inherits ? "changes" : "replaces";
        if (from_library) {
            reader_.problems.note(
                material.loc, "material '" + name + "' " + did + " the one of the OBJ's library");
        }
        for (const int index : old->second) all[static_cast<std::size_t>(index)] = material;
    }

    const Value& tables_;
    SceneReader& reader_;
    std::map<std::string, std::vector<int>, std::less<>> library_;
    std::set<std::string> started_;
    std::set<std::string> done_;
    std::map<std::string, Value, std::less<>> nodes_;
};

}  // namespace

void read_materials(const Value& document, SceneReader& reader) {
    static const Value none{Table{}, {}};
    const Value* tables = document.find("material");
    if (tables && !tables->table()) {
        report_misfit(*tables, "material", "tables named [material.NAME]", {reader.problems, ""});
        tables = nullptr;
    }
    MaterialReader(tables ? *tables : none, reader).read_all();
}

const KeyList& material_keys() { return material_rows().list; }

}  // namespace tessera
