#include <cmath>

#include "renderer/io/light_group_key.h"
#include "renderer/io/scene_reader.h"

namespace tessera {
namespace {

template <class Shape>
struct LightEntry {
    std::string name;
    std::string type;
    bool visible = true;
    std::string light_group;
    Shape shape;
};

std::vector<Key> rows_of(const PointLightDesc&) {
    using L = PointLightDesc;
    return {key("position", &L::position, "Where it is."),
            key("intensity", &L::intensity, "Number or colour, W/sr.", kAtLeast0)};
}

std::vector<Key> rows_of(const SpotLightDesc&) {
    using L = SpotLightDesc;
    return {
        key("position", &L::position, "Where it is."),
        key("direction", &L::direction, "Where it points; any length."),
        key("intensity", &L::intensity, "Number or colour on the axis, W/sr.", kAtLeast0),
        key("cone_deg", &L::cone_deg, "Half angle at which its light ends.",
            {.low = 0, .high = 180, .open_low = true, .open_high = true}),
        key("blend", &L::blend, "Share of the cone over which it fades; 0 is a hard edge.", kUnit)};
}

std::vector<Key> rows_of(const DistantLightDesc&) {
    using L = DistantLightDesc;
    return {key("direction", &L::direction, "The way its light travels; any length."),
            key("irradiance", &L::irradiance, "Number or colour on a surface facing it, W/m2.",
                kAtLeast0),
            key("angle_deg", &L::angle_deg, "Angular diameter; the sun's is 0.533.",
                {.low = 0, .high = 180, .open_high = true})};
}

std::vector<Key> rows_of(const QuadLightDesc&) {
    using L = QuadLightDesc;
    return {
        key("corner", &L::corner, "One corner."),
        key("edges", &L::edges, "The two edges from there; it emits along edges[0] x edges[1]."),
        key("radiance", &L::radiance, "Number or colour, W/m2/sr.", kAtLeast0),
        key("two_sided", &L::two_sided, "Emits to both sides.")};
}

std::vector<Key> rows_of(const DiscLightDesc&) {
    using L = DiscLightDesc;
    return {key("center", &L::center, "Its middle."),
            key("normal", &L::normal, "The way it emits; any length."),
            key("radius", &L::radius, "Its radius.", kAbove0),
            key("radiance", &L::radiance, "Number or colour, W/m2/sr.", kAtLeast0),
            key("two_sided", &L::two_sided, "Emits to both sides.")};
}

std::vector<Key> rows_of(const SphereLightDesc&) {
    using L = SphereLightDesc;
    return {key("center", &L::center, "Its middle."),
            key("radius", &L::radius, "Its radius.", kAbove0),
            key("radiance", &L::radiance, "Number or colour, W/m2/sr.", kAtLeast0)};
}

template <class Shape>
KeySet<LightEntry<Shape>> rows_of_type(const std::string& type) {
    using E = LightEntry<Shape>;
    Key type_row = word("type", &E::type, {type}, "Which kind of light.").must();
    KeySet<E> rows{
        {type + " light", {key("name", &E::name, "What --set calls it."), std::move(type_row)}}};
    add_part(rows, KeySet<Shape>{{type, rows_of(Shape{})}}, &E::shape);
    rows.list.keys.push_back(
        key("visible", &E::visible, "Seen by camera rays; lights with an area only."));
    rows.list.keys.push_back(light_group_key(&E::light_group));
    return rows;
}

using Complain = std::function<void(const char* key, const std::string& message)>;

double length(const Double3& v) { return std::hypot(v[0], v[1], v[2]); }

void check_direction(const Double3& v, const char* key, const Complain& complain) {
    if (!(length(v) > 1e-30)) complain(key, "has no direction");
}

void check_shape(const PointLightDesc&, const Complain&) {}
void check_shape(const SphereLightDesc&, const Complain&) {}
void check_shape(const SpotLightDesc& light, const Complain& c) {
    check_direction(light.direction, "direction", c);
}
void check_shape(const DistantLightDesc& light, const Complain& c) {
    check_direction(light.direction, "direction", c);
}
void check_shape(const DiscLightDesc& light, const Complain& c) {
    check_direction(light.normal, "normal", c);
}
void check_shape(const QuadLightDesc& light, const Complain& complain) {
    const auto& [a, b] = light.edges;
    const Double3 normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]};
    if (!(length(normal) > 1e-9 * length(a) * length(b)) || !(length(normal) > 1e-30)) {
        complain("edges", "span no area");
    }
}

struct LightType {
    std::string name;
    const KeyList* keys;
    LightDesc (*read)(const Value& table, const ReadContext& at);
};

template <class Shape, const char* name>
const KeySet<LightEntry<Shape>>& rows() {
    static const auto keys = rows_of_type<Shape>(name);
    return keys;
}

template <class Shape, const char* name>
LightDesc read_light(const Value& table, const ReadContext& at) {
    LightEntry<Shape> entry;
    read_keys(table, rows<Shape, name>(), entry, at);
    check_shape(entry.shape, [&](const char* key, const std::string& message) {
        const Value* written = table.find(key);
        at.problems.error(written ? written->loc : table.loc,
                          at.subject + ": " + key + " " + message);
    });
    return {entry.name, table.loc, entry.visible, entry.light_group, entry.shape};
}

template <class Shape, const char* name>
LightType type() {
    return {name, &rows<Shape, name>().list, &read_light<Shape, name>};
}

constexpr char kPoint[] = "point", kSpot[] = "spot", kDistant[] = "distant";
constexpr char kQuad[] = "quad", kDisc[] = "disc", kSphere[] = "sphere";

const std::vector<LightType>& light_types() {
    static const std::vector<LightType> types{
        type<PointLightDesc, kPoint>(),     type<SpotLightDesc, kSpot>(),
        type<DistantLightDesc, kDistant>(), type<QuadLightDesc, kQuad>(),
        type<DiscLightDesc, kDisc>(),       type<SphereLightDesc, kSphere>(),
    };
    return types;
}

/// The type a table names; nullptr after reporting.
const LightType* type_of(const Value& table, const ReadContext& at) {
    const Value* written = table.find("type");
    if (!table.table() || !written) {
        const std::string missing = table.table() ? ": key 'type' is missing" : " must be a table";
        at.problems.error(table.loc, at.subject + missing);
        return nullptr;
    }
    Form form{.kind = Form::Kind::choice};
    for (const LightType& type : light_types()) {
        if (written->text() && *written->text() == type.name) return &type;
        form.choices.push_back(type.name);
    }
    report_misfit(*written, "type", describe(form), at);
    return nullptr;
}

}  // namespace

void read_lights(const Value& document, SceneReader& reader) {
    const Value* lights = document.find("light");
    if (!lights) return;
    if (!lights->list())
        return report_misfit(*lights, "light", "written as [[light]]", {reader.problems, ""});
    std::map<std::string, SourceLoc> names;
    std::size_t number = 0;
    for (const Value& table : *lights->list()) {
        const ReadContext at{reader.problems, subject_of("light", table, number++)};
        const LightType* type = type_of(table, at);
        if (!type) continue;
        LightDesc light = type->read(table, at);
        const auto [entry, is_new] = names.emplace(light.name, light.loc);
        if (!is_new && !light.name.empty()) {
            reader.problems.error(light.loc, "the name '" + light.name + "' is taken (at " +
                                                 to_string(entry->second) + ")");
        }
        reader.scene.lights.push_back(std::move(light));
    }
}

std::vector<const KeyList*> light_keys() {
    std::vector<const KeyList*> lists;
    for (const LightType& type : light_types()) lists.push_back(type.keys);
    return lists;
}

}  // namespace tessera
