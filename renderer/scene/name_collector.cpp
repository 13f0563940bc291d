#include "renderer/scene/name_collector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/core/murmur3.h"
#include "renderer/core/utf8.h"

namespace tessera {
namespace {

constexpr const char* kWithoutName[] = {"mesh", "sphere", "disc", "group"};  // by ShapeKind
constexpr double kPiD = 3.14159265358979323846;

std::string first_named(const std::string& name, const std::string& otherwise) {
    return name.empty() ? otherwise : name;
}

std::string shape_name(const SceneDesc& desc, const ShapeRef& shape) {
    const auto of = [&](const auto& shapes) { return shapes[shape.index].name; };
    std::string name;
    switch (shape.kind) {
        case ShapeKind::mesh:
            name = of(desc.meshes);
            break;
        case ShapeKind::sphere:
            name = of(desc.spheres);
            break;
        case ShapeKind::disc:
            name = of(desc.discs);
            break;
        case ShapeKind::group:
            name = of(desc.groups);
            break;
    }
    return first_named(name, kWithoutName[static_cast<std::size_t>(shape.kind)]);
}

double face_area(const Mesh& mesh, std::uint32_t face) {
    const auto at = [&](std::size_t k) {
        return Vec3d(mesh.position(mesh.index[mesh.corner(face) + k]));
    };
    // Of a quad half the product of its diagonals.
    const bool quad = face >= mesh.triangles;
    const Vec3d a = quad ? at(2) - at(0) : at(1) - at(0);
    const Vec3d b = quad ? at(3) - at(1) : at(2) - at(0);
    return 0.5 * length(cross(a, b));
}

double quadric_area(const Geometry& g, const Placement& placed) {
    const auto disc = [](float r) {
        return kPiD * static_cast<double>(r) * static_cast<double>(r);
    };
    return placed.kind == PlacedKind::sphere ? 4 * disc(g.spheres[placed.shape].radius)
                                             : disc(g.discs[placed.shape].radius);
}

std::int32_t quadric_material(const Geometry& g, const Placement& placed) {
    if (placed.material >= 0) return placed.material;
    return placed.kind == PlacedKind::sphere ? g.spheres[placed.shape].material
                                             : g.discs[placed.shape].material;
}

// How a placement scales areas, all directions taken together.
double area_scale(const Placement& placed) {
    if (!placed.instanced) return 1;
    return std::pow(std::abs(Affined(placed.to_world).determinant()), 2.0 / 3.0);
}

}  // namespace

// As readers see it: the manifest is JSON, and ids are hashes of UTF-8.
std::uint32_t NameCollector::Names::of(const std::string& name) {
    const auto [entry, is_new] =
        index.try_emplace(as_utf8(name), static_cast<std::uint32_t>(areas.size()));
    if (is_new) areas.push_back(-1);
    return entry->second;
}

void NameCollector::Names::bear(std::uint32_t name, double area) {
    areas[name] = std::max(areas[name], 0.0) + area;
}

std::vector<std::uint32_t> NameCollector::Names::list(NameList& out) const {
    // Names whose hashes collide are one thing to every reader.
    std::map<std::uint32_t, double> area_by_id;
    for (const auto& [name, i] : index) {
        if (areas[i] < 0) continue;
        out.names.push_back(name);
        area_by_id[cryptomatte_id(name)] += areas[i];
    }
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const auto& [id, area] : area_by_id) order.emplace_back(-area, id);
    std::sort(order.begin(), order.end());
    std::map<std::uint32_t, std::uint32_t> key_of;
    for (const auto& [area, id] : order) {
        key_of[id] = static_cast<std::uint32_t>(out.ids.size());
        out.ids.push_back(id);
    }
    std::vector<std::uint32_t> keys(areas.size(), 0);
    for (const auto& [name, i] : index)
        if (areas[i] >= 0) keys[i] = key_of[cryptomatte_id(name)];
    return keys;
}

NameCollector::NameCollector(const SceneDesc& desc) : desc_(desc) {
    Names& materials = names(NameKind::material);
    out_.materials_.push_back(materials.of("light"));
    for (const MaterialDesc& m : desc.materials)
        out_.materials_.push_back(materials.of(first_named(m.name, "default")));
    for (const InstanceDesc& i : desc.instances)
        assets_.push_back(names(NameKind::asset).of(first_named(i.name, shape_name(desc, i.of))));
}

std::uint32_t NameCollector::add_object(const std::string& name) {
    out_.objects_.push_back(names(NameKind::object).of(name));
    return static_cast<std::uint32_t>(out_.objects_.size() - 1);
}

void NameCollector::add_mesh(const MeshDesc& mesh) {
    const std::string own = first_named(mesh.name, kWithoutName[0]);
    mesh_objects_.push_back(static_cast<std::uint32_t>(out_.objects_.size()));
    std::size_t slots = std::max<std::size_t>(mesh.object_names.size(), 1);
    for (const std::uint32_t slot : mesh.face_object)
        slots = std::max(slots, std::size_t{slot} + 1);
    for (std::size_t i = 0; i < slots; ++i)
        add_object(i < mesh.object_names.size() ? first_named(mesh.object_names[i], own) : own);
}

void NameCollector::add_placement(const FlatInstance& instance, const Placement& placed) {
    const std::uint32_t object =
        placed.kind == PlacedKind::mesh
            ? mesh_objects_[placed.shape]
            : add_object(shape_name(desc_, {instance.kind, instance.index}));
    const std::uint32_t asset = assets_[instance.outermost];
    out_.placements_.push_back({asset, object, copies_[asset]++});
}

void NameCollector::add_light_bodies() {
    for (const LightDesc& light : desc_.lights) {
        const bool has_body = std::holds_alternative<QuadLightDesc>(light.shape) ||
                              std::holds_alternative<DiscLightDesc>(light.shape) ||
                              std::holds_alternative<SphereLightDesc>(light.shape);
        if (!has_body) continue;
        const std::string name = first_named(light.name, "light");
        const std::uint32_t object = add_object(name);
        if (std::holds_alternative<QuadLightDesc>(light.shape)) mesh_objects_.push_back(object);
        out_.placements_.push_back({names(NameKind::asset).of(name), object, 0});
    }
}

void NameCollector::measure(const Geometry& g) {
    struct MeshUse {
        double size = 0;  // as it is stored
        double all = 0,
               bare = 0;  // sums of scales: of all that stand, of those in its own materials
        bool stands = false, stands_bare = false;
    };
    std::vector<MeshUse> uses(g.meshes.size());
    for (std::size_t m = 0; m < uses.size(); ++m)
        for (std::uint32_t f = 0; f < g.meshes[m].faces(); ++f)
            uses[m].size += face_area(g.meshes[m], f);

    for (std::size_t i = 0; i < g.placements.size(); ++i) {
        const Placement& placed = g.placements[i];
        const NameIds::Placed& named = out_.placements_[i];
        const double scale = area_scale(placed);
        double area = 0;
        if (placed.kind == PlacedKind::mesh) {
            MeshUse& use = uses[placed.shape];
            area = use.size * scale;
            use.all += scale, use.stands = true;
            if (placed.material < 0)
                use.bare += scale, use.stands_bare = true;
            else
                bear_material(placed.material, area);
        } else {
            area = quadric_area(g, placed) * scale;
            bear_material(quadric_material(g, placed), area);
            names(NameKind::object).bear(out_.objects_[named.first_object], area);
        }
        names(NameKind::asset).bear(named.asset, area);
    }
    for (std::size_t m = 0; m < uses.size(); ++m) {
        if (!uses[m].stands) continue;
        const Mesh& mesh = g.meshes[m];
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
            const double area = face_area(mesh, f);
            const std::uint32_t slot = mesh.face_object.empty() ? 0 : mesh.face_object[f];
            names(NameKind::object)
                .bear(out_.objects_[mesh_objects_[m] + slot], area * uses[m].all);
            if (uses[m].stands_bare)
                bear_material(mesh.materials[mesh.material_slot(f)], area * uses[m].bare);
        }
    }
}

NameIds NameCollector::finish(const Geometry& geometry) {
    add_light_bodies();
    measure(geometry);
    std::array<std::vector<std::uint32_t>, kNameKinds> keys;
    for (std::size_t k = 0; k < kNameKinds; ++k) keys[k] = names_[k].list(out_.lists_[k]);
    for (std::uint32_t& o : out_.objects_) o = keys[0][o];
    for (std::uint32_t& m : out_.materials_) m = keys[1][m];
    for (NameIds::Placed& p : out_.placements_) p.asset = keys[2][p.asset];
    return std::move(out_);
}

}  // namespace tessera
